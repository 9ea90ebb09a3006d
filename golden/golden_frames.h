#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

/// Tangent frames and the size of a texel of a base mesh (ALGORITHM.md section 6), in double precision. Written from that
/// page; it shares no code with the host.
namespace tessera::golden {

/// In model units; uv spans the map once from 0 to 1.
struct BasePoint {
    glm::dvec3 position{0}, normal{0};
    glm::dvec2 uv{0};
};

struct Frame {
    glm::dvec3 tangent{0};
    int handedness = 1;
    double rounding = 0;  ///< bound on the double-precision error of the tangent's components
};

struct BaseFrames {
    std::vector<std::array<Frame, 3>> corners;  ///< of each triangle
    /// Mean lengths of dp/du and dp/dv, model units; 1 if no triangle has texture area.
    glm::dvec2 size{1, 1};
    double size_rounding = 0;  ///< bound on their relative error
};

/// `triangles`: indices of points, each triangle of non-zero area. Only values count: points that are equal are one.
BaseFrames derive_frames(const std::vector<BasePoint>& points,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tessera::golden
