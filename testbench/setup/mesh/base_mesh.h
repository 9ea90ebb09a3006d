#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tessera {

/// One vertex of the base mesh in model units.
struct BaseVertex {
    glm::dvec3 position{0};
    glm::dvec3 normal{0};   ///< unit length
    glm::dvec3 tangent{0};  ///< unit length, dp/du orthogonalised against the normal, or 0
    double handedness = 1;  ///< +1 or -1: bitangent = handedness * cross(normal, tangent)
    glm::dvec2 texture{0};  ///< u, v as in the file: 0..1 spans the map once; v = 0 is the bottom row
};

/// The lowest and the highest coordinates; needs at least one vertex.
inline std::array<glm::dvec3, 2> bounds_of(const std::vector<BaseVertex>& vertices) {
    glm::dvec3 low(vertices.front().position), high(low);
    for (const BaseVertex& vertex : vertices) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
    }
    return {low, high};
}

/// The base triangle mesh p(u,v), triangulated, with normals and tangent frames complete.
struct BaseMesh {
    std::vector<BaseVertex> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside

    /// Mean of |dp/du| and |dp/dv|, world length of one unit of u and of v, and their spread (texture_scale.h).
    struct TextureScale {
        double mean_u = 1, mean_v = 1;
        double smallest_u = 1, largest_u = 1, smallest_v = 1, largest_v = 1;
    } texture_scale;

    /// Texture coordinates beyond a clamped map are kept instead of clamped, for a lattice that extends beyond the map.
    bool beyond_map = false;

    std::optional<glm::dvec3> up;  ///< the model's up, any length, if the source defines it

    std::size_t dropped_degenerate = 0;  ///< triangles of zero area or with the same vertex twice, dropped at loading
    std::size_t dropped_duplicate = 0;   ///< triangles at the three positions of an earlier triangle, dropped
    std::size_t winding_changes = 0;     ///< edges whose two triangles face opposite ways
    std::vector<std::string> repairs;    ///< one sentence each, for the report: repairs, and anomalies left unchanged
};

}  // namespace tessera
