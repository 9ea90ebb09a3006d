#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "modules/datapath/format.h"
#include "modules/datapath/vertex.h"
#include "testbench/setup/quantised_map.h"

namespace tessera {

/// The tables of the Rank Test and the Bound Test: what a hierarchy of midpoints costs to leave out, an entry a texel,
/// row by row, bottom row first. An edge splits if its ends differ by even whole texels and the entry under its
/// midpoint is greater than the threshold.
///
/// Of the edges of a triangle that the host bisects, the one it bisects first has the greatest entry. So hardware that
/// bisects a triangle's edge of greatest entry only repeats the hierarchy, triangle by triangle, with either table;
/// with both (an edge splits if either test says so), if the rank orders.
///
/// The recursion ends by itself: each bisection halves a triangle's area in texels, and an edge that may split makes
/// twice that area an even number. But a base triangle without area in the map can go on for ever: (0, 0) (2, 0) (3, 0)
/// makes (0, 0) (1, 0) (3, 0), which makes the first again. It needs the Generation Test.
struct RankTables {
    std::uint32_t columns = 0;  ///< texels: the map's, more if it clamps and the base mesh reaches beyond it
    std::uint32_t rows = 0;
    std::vector<std::uint16_t> rank;   ///< empty if not asked for
    std::vector<std::uint16_t> bound;  ///< empty if not asked for

    /// The largest error when every edge splits that can, codes. 0 on a lattice (lattice.h).
    double least_error = 0;
    /// No grid point's vertical error exceeds bound_error(threshold) and least_error, for thresholds up to this one, if
    /// there are no clashes.
    std::uint32_t highest_bound_threshold = 0;
    /// Midpoints that share their texel with another, whose entry is the greater one: none on a lattice.
    std::uint64_t clashes = 0;
};

/// base: texture coordinates of the base triangles, in the texture's format. bits of an entry: 0 for no such table, or
/// 6 to 16.
RankTables make_rank_tables(const QuantisedMap& map, const std::vector<std::array<datapath::TexCoord, 3>>& base,
                            const datapath::Formats& formats, int rank_bits, int bound_bits);

/// Edges of the base mesh, each counted once, that can never split.
std::uint64_t count_whole_base_edges(const std::vector<std::array<datapath::TexCoord, 3>>& base,
                                     const datapath::Formats& formats);

/// The Rank Test's register: an edge is bisected if that lowers the squared error by more than the square of
/// `error_per_triangle` (codes) per triangle it adds. Entry: 16 + log2 of codes^2, 6 bits in front of the point.
std::uint32_t rank_threshold(double error_per_triangle, int bits);

/// The least such error that a register stands for, codes.
double rank_error(std::uint32_t threshold, int bits);

/// The Bound Test's register for a largest vertical error, in codes, rounded down. Entry: 8 + log2 of codes, 5 bits in
/// front of the point.
std::uint32_t bound_threshold(double largest_error, int bits);

/// The largest error that a threshold promises, in codes.
double bound_error(std::uint32_t threshold, int bits);

}  // namespace tessera
