#include "testbench/output/report/indexed_mesh.h"

#include <algorithm>

#include "testbench/common/distinct_table.h"
#include "testbench/common/error.h"

namespace tessera {
namespace {

using Corner = EmittedTriangle::Corner;

constexpr std::size_t most_triangles = 700'000'000;  // three vertices each still have a signed 32-bit number

bool same(const Corner& a, const Corner& b) {
    return a.position == b.position && a.displaced == b.displaced && a.displaced_normal == b.displaced_normal &&
           a.texture == b.texture;
}

}  // namespace

IndexedMesh IndexedMesh::from(const EmittedMesh& mesh) {
    if (mesh.triangles.size() > most_triangles)
        throw ResourceError("the mesh has more than " + std::to_string(most_triangles) +
                            " triangles, the most a mesh file can index; set output.ply and output.obj to false");
    const std::vector<Corner>& corners = mesh.triangles.corners();
    IndexedMesh result;
    result.triangles.reserve(mesh.triangles.size());
    DistinctTable table;
    constexpr std::uint32_t unknown = UINT32_MAX;
    std::vector<std::uint32_t> vertex_of(corners.size(), unknown);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.triangles[t].culled)
            continue;
        Triangle& triangle = result.triangles.emplace_back();
        triangle.triangle = t;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t c = mesh.triangles.corner_indices(t)[k];
            if (vertex_of[c] == unknown)
                vertex_of[c] = table.number_of(
                    hash_of(corners[c]), [&](std::uint32_t v) { return same(corners[result.vertices[v]], corners[c]); },
                    [&](std::uint32_t v) { return hash_of(corners[result.vertices[v]]); });
            if (vertex_of[c] == result.vertices.size())
                result.vertices.push_back(c);
            triangle.vertices[k] = vertex_of[c];
        }
    }
    return result;
}

std::uint8_t triangle_generation(const EmittedTriangle& triangle) {
    const auto& c = triangle.corners;
    return std::max({c[0].generation, c[1].generation, c[2].generation});
}

RecordedMesh recorded_mesh(const EmittedMesh& mesh, const MeshUnits& units) {
    const IndexedMesh indexed = IndexedMesh::from(mesh);
    RecordedMesh result;
    result.positions.reserve(indexed.vertices.size());
    result.normals.reserve(indexed.vertices.size());
    result.textures.reserve(indexed.vertices.size());
    result.triangles.reserve(indexed.triangles.size());
    for (const std::uint32_t vertex : indexed.vertices) {
        const Corner& corner = mesh.triangles.corners()[vertex];
        result.positions.push_back(units.position(corner.displaced));
        result.normals.push_back(units.normal(corner.displaced_normal));
        result.textures.push_back(units.texture(corner.texture));
    }
    for (const IndexedMesh::Triangle& t : indexed.triangles) {
        const EmittedTriangle& triangle = mesh.triangles[t.triangle];
        result.triangles.push_back(
            {t.vertices, triangle_generation(triangle), triangle.split_by, triangle.stopped_by, triangle.base});
    }
    return result;
}

}  // namespace tessera
