#include "testbench/output/report/indexed_mesh.h"

#include <algorithm>

#include "testbench/common/distinct_table.h"
#include "testbench/common/error.h"

namespace tessera {
namespace {

using Corner = EmittedTriangle::Corner;

constexpr std::size_t most_triangles = 700'000'000;  // three vertices each still have a signed 32-bit number

std::uint64_t hash(const Corner& c) {
    std::uint64_t result = 0;
    for (const std::int32_t word : {c.position.x, c.position.y, c.position.z, c.displaced.x, c.displaced.y,
                                    c.displaced.z, c.displaced_normal.x, c.displaced_normal.y, c.displaced_normal.z,
                                    static_cast<std::int32_t>(c.texture.u), static_cast<std::int32_t>(c.texture.v)})
        result = mix_hash(result, static_cast<std::uint32_t>(word));
    return result;
}

bool same(const Corner& a, const Corner& b) {
    return a.position == b.position && a.displaced == b.displaced && a.displaced_normal == b.displaced_normal &&
           a.texture == b.texture;
}

}  // namespace

IndexedMesh IndexedMesh::from(const EmittedMesh& mesh) {
    if (mesh.triangles.size() > most_triangles)
        throw ResourceError("the mesh has more than " + std::to_string(most_triangles) +
                            " triangles, the most a mesh file can index; set output.ply and output.obj to false");
    IndexedMesh result;
    std::size_t count = 0;
    for (const EmittedTriangle& triangle : mesh.triangles)
        count += triangle.culled ? 0 : 1;
    result.triangles.reserve(count);

    DistinctTable table;
    const auto corner = [&](std::uint32_t vertex) -> const Corner& {
        const Vertex& v = result.vertices[vertex];
        return mesh.triangles[v.triangle].corners[v.corner];
    };
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.triangles[i].culled)
            continue;
        Triangle triangle{i, {}};
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Corner& c = mesh.triangles[i].corners[k];
            triangle.vertices[k] = table.number_of(
                hash(c), [&](std::uint32_t v) { return same(corner(v), c); },
                [&](std::uint32_t v) { return hash(corner(v)); });
            if (triangle.vertices[k] == result.vertices.size())
                result.vertices.push_back({i, k});
        }
        result.triangles.push_back(triangle);
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
    for (const IndexedMesh::Vertex& v : indexed.vertices) {
        const auto& corner = mesh.triangles[v.triangle].corners[v.corner];
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
