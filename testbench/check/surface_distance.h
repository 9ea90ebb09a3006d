#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tessera {

/// Triangles as bare positions.
using TriangleSoup = std::vector<std::array<glm::dvec3, 3>>;

/// The point of a triangle nearest to p. A collapsed triangle is the segment or point it collapsed to.
glm::dvec3 closest_point(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& p);

struct SurfaceDistance {
    std::uint64_t points = 0;
    double max = 0;
    double rms = 0;
};

/// From every vertex (once) and every centroid of `from` to the nearest point of `to`. Infinite if `to` is
/// empty and `from` is not. Distances are in double precision; Embree's single precision only sorts the
/// triangles out.
SurfaceDistance distance_between(const TriangleSoup& from, const TriangleSoup& to);

}  // namespace tessera
