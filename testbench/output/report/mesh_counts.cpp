#include "testbench/output/report/mesh_counts.h"

#include <algorithm>
#include <vector>

#include "testbench/common/hash.h"

namespace tessera {

namespace {

/// Its lowest bit is set if the vertex was inserted.
std::uint64_t vertex_hash(const EmittedTriangle::Corner& c) {
    std::uint64_t hash = 0;
    for (const std::int32_t word :
         {static_cast<std::int32_t>(c.texture.u), static_cast<std::int32_t>(c.texture.v), c.displaced.x, c.displaced.y,
          c.displaced.z, c.displaced_normal.x, c.displaced_normal.y, c.displaced_normal.z})
        hash = mix_hash(hash, static_cast<std::uint32_t>(word));
    return (hash & ~std::uint64_t{1}) | (c.generation > 0 ? 1 : 0);
}

void keep_distinct(std::vector<std::uint64_t>& hashes) {
    std::sort(hashes.begin(), hashes.end());
    hashes.erase(std::unique(hashes.begin(), hashes.end()), hashes.end());
}

}  // namespace

MeshCounts count_mesh(const EmittedMesh& mesh) {
    MeshCounts counts;
    std::vector<std::uint64_t> vertices;
    vertices.reserve(mesh.triangles.corners().size());
    for (const EmittedTriangle::Corner& corner : mesh.triangles.corners())
        vertices.push_back(vertex_hash(corner));
    std::vector<std::uint64_t> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& corners = mesh.triangles.corner_indices(t);
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(vertices[corners[k]], vertices[corners[(k + 1) % 3]]);
            edges.push_back(mix_hash(mix_hash(0, low), high));
        }
    }
    keep_distinct(edges);
    counts.edges = edges.size();
    keep_distinct(vertices);
    counts.vertices = vertices.size();
    counts.inserted_vertices = static_cast<std::uint64_t>(
        std::count_if(vertices.begin(), vertices.end(), [](std::uint64_t hash) { return (hash & 1) != 0; }));
    return counts;
}

}  // namespace tessera
