#pragma once
#include <cstdint>

#include "testbench/geometry/nearest_triangle.h"

namespace tessera {

/// How far the points of one surface lie from the other: every vertex (once) and every centroid.
struct SurfaceDistance {
    std::uint64_t points = 0;    ///< of the surface
    std::uint64_t measured = 0;  ///< so many of them; all, unless there are more than the limit
    std::uint64_t farther = 0;   ///< of those measured, farther away than `near`
    double max = 0;
    double rms = 0;

    /// The part of all points that may lie farther away than `max`: a larger part would have shown itself with the
    /// probability `confidence`. 0 if all were measured.
    double unseen(double confidence) const;

    /// Of those measured.
    double farther_percent() const {
        return measured == 0 ? 0 : 100 * static_cast<double>(farther) / static_cast<double>(measured);
    }
};

/// How many boxes may be looked at in all: some two seconds. Of about 30 a point on a usual surface, on a
/// thicket of long thin triangles thousands.
inline constexpr std::uint64_t most_looks = std::uint64_t{1} << 24;

/// From the points of `from` to the nearest point of `to`. Infinite if `to` is empty and `from` is not.
///
/// If measuring all points would take more than `most` looks, a subset is measured: the points, in the soup's
/// order, are cut into equal parts, a power of two in number, and a seeded random number chooses one of each.
/// What a point takes follows from the boxes in which some of the points lie. Distances are in double
/// precision; Embree's single precision only sorts the triangles out. The same soups give the same result on
/// any number of threads.
SurfaceDistance distance_between(const TriangleSoup& from, const TriangleSoup& to,
                                 std::uint64_t most = most_looks, double near = 0);

}  // namespace tessera
