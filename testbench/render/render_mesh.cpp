#include "testbench/render/render_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "testbench/common/distinct_table.h"
#include "testbench/output/report/indexed_mesh.h"

namespace tessera {
namespace {

/// An origin near the middle of the mesh: a multiple of its size, so that a mesh around 0 keeps its coordinates.
glm::dvec3 choose_origin(const RecordedMesh& mesh) {
    if (mesh.triangles.empty())
        return glm::dvec3(0);
    glm::dvec3 low = mesh.positions[mesh.triangles.front().vertices[0]];
    glm::dvec3 high = low;
    for (const RecordedMesh::Triangle& triangle : mesh.triangles)
        for (const glm::dvec3& position : mesh.corners(triangle)) {
            low = glm::min(low, position);
            high = glm::max(high, position);
        }
    const glm::dvec3 size = high - low;
    const double largest = std::max({size.x, size.y, size.z});
    if (largest <= 0)
        return low;
    const double step = std::ldexp(1.0, std::ilogb(largest) + 1);
    glm::dvec3 origin;
    for (int k = 0; k < 3; ++k)
        origin[k] = std::nearbyint((low[k] / 2 + high[k] / 2) / step) * step;
    return origin;
}

}  // namespace

RenderMesh make_render_mesh(const RecordedMesh& mesh) {
    RenderMesh result;
    result.origin = choose_origin(mesh);
    DistinctTable table;
    constexpr std::uint32_t unknown = UINT32_MAX;
    std::vector<std::uint32_t> number_of(mesh.positions.size(), unknown);
    const auto add_vertex = [&](std::uint32_t vertex) {
        const glm::vec3 position = mesh.positions[vertex] - result.origin, normal = mesh.normals[vertex];
        number_of[vertex] = table.number_of(
            point_hash(position),
            [&](std::uint32_t v) { return result.positions[v] == position && result.normals[v] == normal; },
            [&](std::uint32_t v) { return point_hash(result.positions[v]); });
        if (number_of[vertex] == result.positions.size()) {
            result.positions.push_back(position);
            result.normals.push_back(normal);
        }
    };
    std::vector<std::uint32_t> bases;
    result.triangles.reserve(mesh.triangles.size());
    bases.reserve(mesh.triangles.size());
    for (const RecordedMesh::Triangle& from : mesh.triangles) {
        RenderMesh::Triangle triangle{{}, from.generation, deciding_test_of(from.split_by), from.stopped_by};
        for (std::size_t k = 0; k < 3; ++k) {
            if (number_of[from.vertices[k]] == unknown)
                add_vertex(from.vertices[k]);
            triangle.vertices[k] = number_of[from.vertices[k]];
        }
        result.triangles.push_back(triangle);
        bases.push_back(from.base);
    }
    std::sort(bases.begin(), bases.end());
    result.base_triangles = static_cast<std::uint64_t>(std::unique(bases.begin(), bases.end()) - bases.begin());
    return result;
}

RenderMesh make_render_mesh(const EmittedMesh& mesh, const MachineSetup& setup) {
    return make_render_mesh(recorded_mesh(
        mesh, {setup.registers.formats, setup.registers.map, setup.model_scale.scale, setup.model_scale.centre}));
}

}  // namespace tessera
