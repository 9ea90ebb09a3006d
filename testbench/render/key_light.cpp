#include "testbench/render/key_light.h"

#include "testbench/render/style.h"

namespace tessera {
namespace {

// Of |mean normal|: 1 for a plane, 0 for a closed surface.
constexpr double sheet_from = 0.6;

// Sine and cosine of a sun 38 degrees above the sheet.
constexpr double sun_up = 0.616;
constexpr double sun_across = 0.788;

}  // namespace

glm::dvec3 choose_key_light(const RenderMesh& mesh, const View& view) {
    glm::dvec3 sum(0);
    double area = 0;
    for (const RenderMesh::Triangle& triangle : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[triangle.vertices[0]];
        const glm::dvec3 b = mesh.positions[triangle.vertices[1]];
        const glm::dvec3 c = mesh.positions[triangle.vertices[2]];
        const glm::dvec3 across = glm::cross(b - a, c - a);
        sum += across;
        area += glm::length(across);
    }
    const glm::dvec3 usual = Style{}.key_light;
    if (!(area > 0) || glm::length(sum) < sheet_from * area)
        return usual;
    glm::dvec3 normal(glm::dot(sum, view.right), glm::dot(sum, view.up), glm::dot(sum, view.backward));
    normal = glm::normalize(normal.z < 0 ? -normal : normal);
    const glm::dvec3 from_left(-0.95, 0.3, 0);
    const glm::dvec3 along = from_left - glm::dot(from_left, normal) * normal;
    if (glm::length(along) < 0.1)
        return usual;
    return sun_up * normal + sun_across * glm::normalize(along);
}

}  // namespace tessera
