#include "testbench/render/error_range.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace tessera {
namespace {

double area_of(const RenderMesh& mesh, std::size_t index) {
    const RenderMesh::Triangle& triangle = mesh.triangles[index];
    const glm::dvec3 a = mesh.positions[triangle.vertices[0]];
    const glm::dvec3 b = mesh.positions[triangle.vertices[1]];
    const glm::dvec3 c = mesh.positions[triangle.vertices[2]];
    return glm::length(glm::cross(b - a, c - a)) / 2;
}

}  // namespace

double error_of_most(const RenderMesh& mesh, double share) {
    const std::vector<float>& errors = mesh.triangle_errors;
    std::vector<std::size_t> order(errors.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return errors[a] < errors[b]; });
    double area = 0;
    for (const std::size_t i : order)
        area += area_of(mesh, i);
    double below = 0;
    for (const std::size_t i : order) {
        below += area_of(mesh, i);
        if (area > 0 && below >= share * area)
            return static_cast<double>(errors[i]);
    }
    return largest_of(errors);
}

double largest_of(const std::vector<float>& errors) {
    return errors.empty() ? 0 : static_cast<double>(*std::max_element(errors.begin(), errors.end()));
}

}  // namespace tessera
