#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "modules/datapath/format.h"
#include "modules/datapath/vertex.h"
#include "testbench/setup/quantised_map.h"
#include "testbench/setup/tables/split_hierarchy.h"

namespace tessera {

/// The tables of the Rank Test and the Bound Test: the cost of leaving out each midpoint of a hierarchy, one entry per
/// texel, row by row, bottom row first. An edge splits if its ends differ by even whole texels and the entry under its
/// midpoint exceeds the threshold.
///
/// Of a triangle's edges that the host bisects, the one it bisects first has the greatest entry. So hardware that
/// bisects the edge with the greatest entry reproduces the hierarchy, triangle by triangle, with either table; with
/// both (an edge splits if either test requests it), if edges are ordered by rank.
///
/// The recursion terminates by itself: each bisection halves a triangle's area in texels, and an edge that may split
/// makes twice that area an even number. But a base triangle without area in the map may recurse forever: (0, 0) (2, 0)
/// (3, 0) makes (0, 0) (1, 0) (3, 0), which makes the first again. It needs the Generation Test.
struct RankTables {
    std::uint32_t columns = 0;  ///< texels: the map's, or more if it clamps and the base mesh extends beyond it
    std::uint32_t rows = 0;
    std::vector<std::uint16_t> rank;   ///< empty if not requested
    std::vector<std::uint16_t> bound;  ///< empty if not requested
    /// Beside bounds, if asked for. What is nearest to the eye of all that a midpoint concerns, and of all that needs it,
    /// is nearer than its edge's ends by no more: a midpoint that is needed is never left out, wherever the eye is.
    std::vector<std::uint8_t> radius;

    /// The largest error, in codes, if every possible edge splits. 0 on a lattice (split_hierarchy.h).
    double least_error = 0;
    /// No grid point's vertical error exceeds bound_error(threshold) and least_error, for thresholds up to this one, if
    /// there are no clashes. With radii a threshold may differ from midpoint to midpoint (modules/datapath/rank_view.h).
    std::uint32_t highest_bound_threshold = 0;
    /// Midpoints that share their texel with another, whose entry is the greater one: none on a lattice.
    std::uint64_t clashes = 0;
    /// The base mesh is longer than a period of the map on a repeated axis: an edge that the author leaves whole may have the
    /// midpoint of another, a period away, and splits with it.
    bool beyond_period = false;
    /// The midpoints in the order of their bisection, on a repeated axis within the map: the author's choice, from which
    /// all entries follow.
    std::vector<datapath::TexCoord> midpoints;
    /// The highest generation of the midpoints whose bound exceeds a threshold, by threshold; 0: there are none.
    std::vector<std::uint8_t> generations;

    int highest_generation(std::int64_t threshold) const {
        const auto at = static_cast<std::size_t>(std::max<std::int64_t>(threshold, 0));
        return at < generations.size() ? generations[at] : 0;
    }
};

/// The scale of radii, in LSB of a vertex's distance.
struct RadiusScale {
    SurfaceSteps steps;
    double rounding = 0;  ///< bound on the total error of two sums of two distances
};

/// base: texture coordinates of the base triangles, in the texture's format. bits of an entry: 0 for no such table, or
/// 6 to 16. radii: requests radii beside bounds; needs a flat base mesh.
RankTables make_rank_tables(const QuantisedMap& map, const std::vector<std::array<datapath::TexCoord, 3>>& base,
                            const datapath::Formats& formats, int rank_bits, int bound_bits,
                            const std::optional<RadiusScale>& radii = {});

/// The number of base mesh edges, each counted once, that can never split.
std::uint64_t count_whole_base_edges(const std::vector<std::array<datapath::TexCoord, 3>>& base,
                                     const datapath::Formats& formats);

/// The Rank Test's register: an edge is bisected if that lowers the squared error by more than the square of
/// `error_per_triangle` (codes) per triangle it adds. Entry: 16 + log2 of codes^2, 6 bits in front of the point.
std::uint32_t rank_threshold(double error_per_triangle, int bits);

/// The least such error that a register represents, in codes.
double rank_error(std::uint32_t threshold, int bits);

/// The Bound Test's register for a largest vertical error, in codes, rounded down. Entry: 8 + log2 of codes, 5 bits in
/// front of the point.
std::uint32_t bound_threshold(double largest_error, int bits);

/// The largest error that a threshold guarantees, in codes.
double bound_error(std::uint32_t threshold, int bits);

/// The view from which errors are judged (modules/datapath/rank_view.h).
struct ViewedScale {
    double focal = 1;          ///< size in pixels of an object of height 1 at distance 1 in the picture's centre
    double corner_secant = 1;  ///< of the angle between the view's axis and a corner of the picture
    double step = 1;           ///< of a vertex's distance, world units per LSB
    double code = 1;           ///< height of a code, world units
    double texel = 1;          ///< side of a texel, world units: the root of its area
};

/// The Rank Test's register for errors seen, whatever an entry's bits: pixels times the root of a texel; per pixel:
/// pixels times the root of the pixels that the triangles cover.
std::int32_t seen_rank_threshold(double error, bool per_pixel, const ViewedScale& view);

/// The Bound Test's register for a largest vertical error of `pixels` anywhere in the picture.
std::int32_t seen_bound_threshold(double pixels, const ViewedScale& view);

}  // namespace tessera
