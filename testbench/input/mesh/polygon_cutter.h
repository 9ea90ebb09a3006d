#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace tessera {

struct PolygonCut {
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corner numbers; may hold flat ones
    bool crosses_itself = false;  ///< found always up to 256 corners, beyond that where ears run out
    bool nonplanar = false;       ///< a corner is off the mean plane by more than 1/20 of the size
};

/// Cuts a polygon of three corners or more into triangles that keep its winding, every corner used; nothing if that
/// would take more steps than `work_left`, from which what it takes is taken.
///
/// Strictly convex: a fan from the first corner; of more than 8, every second corner is cut off first, round by
/// round. Otherwise ear clipping in the plane's projection along its largest normal component (Meisters 1975),
/// with these additions: an ear has positive area and no corner on its border, so that corners on a straight
/// edge give no triangle without area and no T-junction; where no ear is left (the outline crosses itself), the
/// rest is cut as a fan.
///
/// Not tinyobjloader's: it cuts any quad along its shorter diagonal, which may lie outside, and what it takes for an
/// ear of a larger polygon depends on where the origin lies, so concave ones get triangles turned over or none.
std::optional<PolygonCut> cut_polygon(const std::vector<glm::dvec3>& corners, std::uint64_t& work_left);

}  // namespace tessera
