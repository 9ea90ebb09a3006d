#include "testbench/report/indexed_mesh.h"

#include <algorithm>

#include "testbench/common/error.h"

namespace tessera {
namespace {

using Corner = EmittedTriangle::Corner;

constexpr std::size_t most_triangles = 700'000'000;  // three vertices each still have a signed 32-bit number

std::uint64_t hash(const Corner& c) {
    std::uint64_t result = 0;
    for (const std::int32_t word :
         {c.position.x, c.position.y, c.position.z, c.displaced.x, c.displaced.y, c.displaced.z,
          c.displaced_normal.x, c.displaced_normal.y, c.displaced_normal.z,
          static_cast<std::int32_t>(c.texture.u), static_cast<std::int32_t>(c.texture.v)}) {
        result = (result ^ static_cast<std::uint32_t>(word)) * 0x9e3779b97f4a7c15u;
        result ^= result >> 29;
    }
    return result * 0xbf58476d1ce4e5b9u >> 8;
}

bool same(const Corner& a, const Corner& b) {
    return a.position == b.position && a.displaced == b.displaced &&
           a.displaced_normal == b.displaced_normal && a.texture == b.texture;
}

}  // namespace

IndexedMesh IndexedMesh::from(const EmittedMesh& mesh) {
    if (mesh.triangles.size() > most_triangles)
        throw ResourceError(
            "the mesh has more than " + std::to_string(most_triangles) +
            " triangles, more than a mesh file can number; switch output.ply and output.obj off");
    IndexedMesh result;
    std::size_t count = 0;
    for (const EmittedTriangle& triangle : mesh.triangles)
        count += triangle.culled ? 0 : 1;
    result.triangles.reserve(count);

    constexpr std::uint32_t empty = UINT32_MAX;
    std::vector<std::uint32_t> table(std::size_t{1} << 10, empty);
    const auto corner = [&](const Vertex& v) -> const Corner& {
        return mesh.triangles[v.triangle].corners[v.corner];
    };
    const auto slot_of = [&](const Corner& c) -> std::uint32_t& {
        std::size_t slot = static_cast<std::size_t>(hash(c)) & (table.size() - 1);
        while (table[slot] != empty && !same(corner(result.vertices[table[slot]]), c))
            slot = (slot + 1) & (table.size() - 1);
        return table[slot];
    };
    const auto grow = [&] {
        table.assign(2 * table.size(), empty);
        for (std::uint32_t v = 0; v < result.vertices.size(); ++v)
            slot_of(corner(result.vertices[v])) = v;
    };
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.triangles[i].culled)
            continue;
        Triangle triangle{i, {}};
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint32_t& slot = slot_of(mesh.triangles[i].corners[k]);
            if (slot == empty) {
                slot = static_cast<std::uint32_t>(result.vertices.size());
                result.vertices.push_back({i, k});
            }
            triangle.vertices[k] = slot;
            if (3 * result.vertices.size() > 2 * table.size())
                grow();
        }
        result.triangles.push_back(triangle);
    }
    return result;
}

std::uint8_t triangle_generation(const EmittedTriangle& triangle) {
    const auto& c = triangle.corners;
    return std::max({c[0].generation, c[1].generation, c[2].generation});
}

}  // namespace tessera
