#pragma once
#include <cstdint>

#include "testbench/check/nearest_triangle.h"

namespace tessera {

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
