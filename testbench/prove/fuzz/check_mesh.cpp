#include <cmath>

#include "testbench/common/error.h"
#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/input/mesh/obj_reader.h"
#include "testbench/prove/fuzz/fuzz_target.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera::fuzz {

namespace {

constexpr double rounding = 1e-14;  // error of a unit vector's length and of the cosine of a right angle

void promise_vertex(const BaseVertex& v) {
    for (int k = 0; k < 3; ++k)
        promise(std::abs(v.position[k]) <= largest_coordinate, "a position is not finite");
    for (int k = 0; k < 2; ++k)
        promise(std::isfinite(v.texture[k]), "a texture coordinate is not finite");
    promise(std::abs(safe_length(v.normal) - 1) < rounding, "a normal is not of unit length");
    promise(std::abs(safe_length(v.tangent) - 1) < rounding || v.tangent == glm::dvec3(0),
            "a tangent is neither of unit length nor zero");
    promise(std::abs(glm::dot(v.normal, v.tangent)) < rounding, "a tangent is not perpendicular to its normal");
    promise(v.handedness == 1 || v.handedness == -1, "a handedness is neither 1 nor -1");
}

void promise_scale(const BaseMesh::TextureScale& s) {
    constexpr double mean_rounding = 1 + 1e-12;
    promise(std::isfinite(s.largest_u) && std::isfinite(s.largest_v), "a texture scale is not finite");
    promise(s.smallest_u <= s.mean_u * mean_rounding && s.mean_u <= s.largest_u * mean_rounding,
            "the mean texture scale in u is not between the smallest and the largest");
    promise(s.smallest_v <= s.mean_v * mean_rounding && s.mean_v <= s.largest_v * mean_rounding,
            "the mean texture scale in v is not between the smallest and the largest");
}

/// Checks the guarantees of base_mesh.h.
void promise_complete(const BaseMesh& mesh) {
    promise(!mesh.triangles.empty(), "the mesh has no triangles");
    for (const auto& t : mesh.triangles) {
        for (const std::uint32_t i : t)
            promise(i < mesh.vertices.size(), "a triangle names a vertex that does not exist");
        promise(triangle_normal(mesh.vertices[t[0]].position, mesh.vertices[t[1]].position,
                                mesh.vertices[t[2]].position) != glm::dvec3(0),
                "a triangle has no area");
    }
    for (const BaseVertex& vertex : mesh.vertices)
        promise_vertex(vertex);
    promise_scale(mesh.texture_scale);
    for (const std::string& repair : mesh.repairs)
        promise(!repair.empty(), "a repair is empty");
}

}  // namespace

void check_obj(std::string_view bytes) {
    const std::string name = "fuzzed";
    try {
        promise_complete(parse_obj(bytes, name));
    } catch (const InputError& error) {
        promise_message(error.what(), name);
    } catch (const ResourceError& error) {
        promise_message(error.what(), name);
    }
}

}  // namespace tessera::fuzz
