#pragma once
#include <cstdint>

#include "testbench/geometry/nearest_triangle.h"

namespace tessera {

/// Distances from the points of one surface, every vertex (once) and every centroid, to the other surface.
struct SurfaceDistance {
    std::uint64_t points = 0;    ///< on the surface
    std::uint64_t measured = 0;  ///< points measured; all, unless there are more than the limit
    std::uint64_t farther = 0;   ///< measured points farther away than `near`
    double max = 0;
    double rms = 0;

    /// The fraction of all points that may lie farther away than `max`: a larger fraction would have been found with
    /// probability `confidence`. 0 if all were measured.
    double unseen(double confidence) const;

    /// In percent of the measured points.
    double farther_percent() const {
        return measured == 0 ? 0 : 100 * static_cast<double>(farther) / static_cast<double>(measured);
    }
};

/// Limit on box visits in all, about two seconds. A point needs about 30 on an ordinary surface, thousands among many
/// overlapping long thin triangles.
inline constexpr std::uint64_t most_looks = std::uint64_t{1} << 24;

/// Distances from the points of `from` to the nearest point of `to`. Infinite if `to` is empty and `from` is not.
///
/// If measuring all points would take more than `most` box visits, a subset is measured: the points, in the soup's
/// order, are divided into equal parts, a power of two in number, and a seeded random number selects one of each. The
/// cost of a point is estimated from the number of boxes that contain some pilot points. Distances are in double
/// precision; boxes in single precision only exclude triangles. The same soups give the same result on any number of
/// threads.
SurfaceDistance distance_between(const TriangleSoup& from, const TriangleSoup& to, std::uint64_t most = most_looks,
                                 double near = 0);

}  // namespace tessera
