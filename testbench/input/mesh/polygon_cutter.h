#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace tessera {

struct PolygonCut {
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corner indices; may contain flat triangles
    bool crosses_itself = false;  ///< always detected up to 256 corners, beyond that if no ear is left
    bool nonplanar = false;       ///< a corner's distance from the mean plane exceeds 1/20 of the size
};

/// Triangulates a polygon of three corners or more; the triangles keep its winding and use every corner. Nothing if it
/// would take more steps than `work_left`, which is reduced by the steps taken.
///
/// Strictly convex: a fan from the first corner; with more than 8 corners, every second one is cut off first, round by
/// round. Otherwise ear clipping in the projection along the largest component of the plane's normal (Meisters 1975),
/// with these additions: an ear has positive area and no corner on its border, so that corners on a straight edge cause
/// neither triangles without area nor T-junctions; if no ear is left (the outline crosses itself), the rest is a fan.
///
/// tinyobjloader's triangulation is not used: it splits any quad along its shorter diagonal, which may lie outside, and
/// its ears in larger polygons depend on the origin's position, so that concave ones get inverted triangles or none.
std::optional<PolygonCut> cut_polygon(const std::vector<glm::dvec3>& corners, std::uint64_t& work_left);

}  // namespace tessera
