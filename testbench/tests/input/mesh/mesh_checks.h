#pragma once
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/mesh/equal_groups.h"
#include "testbench/setup/mesh/triangle_geometry.h"

namespace tessera {

/// Edges by position: those of one triangle, those of two triangles with opposite directions, and all others.
struct EdgeCounts {
    std::size_t border = 0, shared = 0, odd = 0;
};

inline EdgeCounts count_edges(const BaseMesh& mesh) {
    using Edge = std::pair<PositionKey, PositionKey>;
    std::map<Edge, std::pair<int, int>> uses;
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const PositionKey a = position_key(mesh.vertices[t[k]].position);
            const PositionKey b = position_key(mesh.vertices[t[(k + 1) % 3]].position);
            ++(a < b ? uses[{a, b}].first : uses[{b, a}].second);
        }
    }
    EdgeCounts counts;
    for (const auto& [edge, use] : uses) {
        ++(use.first + use.second == 1         ? counts.border
           : use.first == 1 && use.second == 1 ? counts.shared
                                               : counts.odd);
    }
    return counts;
}

/// Properties of every base mesh, whatever its source.
inline void require_complete(const BaseMesh& mesh) {
    REQUIRE_FALSE(mesh.triangles.empty());
    std::size_t bad_indices = 0, flat = 0, bad_frames = 0, bad_values = 0;
    for (const auto& t : mesh.triangles)
        for (std::uint32_t i : t)
            bad_indices += i >= mesh.vertices.size();
    REQUIRE(bad_indices == 0);
    for (const auto& t : mesh.triangles) {
        flat += triangle_normal(mesh.vertices[t[0]].position, mesh.vertices[t[1]].position,
                                mesh.vertices[t[2]].position) == glm::dvec3(0);
    }
    for (const BaseVertex& v : mesh.vertices) {
        bad_frames += !(std::abs(safe_length(v.normal) - 1) < 1e-14) ||
                      !(std::abs(safe_length(v.tangent) - 1) < 1e-14 || v.tangent == glm::dvec3(0)) ||
                      !(std::abs(glm::dot(v.normal, v.tangent)) < 1e-14) || std::abs(v.handedness) != 1;
        bad_values += !std::isfinite(v.position.x + v.position.y + v.position.z + v.texture.x + v.texture.y);
    }
    REQUIRE(flat == 0);
    REQUIRE(bad_frames == 0);
    REQUIRE(bad_values == 0);
    const BaseMesh::TextureScale& s = mesh.texture_scale;
    REQUIRE(std::isfinite(s.largest_u + s.largest_v));
    REQUIRE(s.smallest_u <= s.mean_u * (1 + 1e-12));
    REQUIRE(s.mean_u <= s.largest_u * (1 + 1e-12));
    REQUIRE(s.smallest_v <= s.mean_v * (1 + 1e-12));
    REQUIRE(s.mean_v <= s.largest_v * (1 + 1e-12));
}

}  // namespace tessera
