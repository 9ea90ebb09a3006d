#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "golden/golden_map.h"

namespace tessera::golden {

/// Values on both sides of what exact arithmetic gives, since doubles round: nearly always equal.
struct EntryRange {
    double low = 0, high = 0;
};

/// What a Rank Table is made from (ALGORITHM.md section 6, Rank Table).
struct RankSource {
    std::vector<std::array<glm::dvec2, 3>> base;  ///< base triangles' corners, in texels
    std::int64_t columns = 0, rows = 0;           ///< of the table
    int rank_bits = 0, bound_bits = 0;            ///< 0: the table has none
    bool radii = false;
    glm::dvec3 steps{0};  ///< sizes of a texel along u and along v, and of a code, in last places of a distance
    double rounding = 0;  ///< of a radius, which is a sum of two distances, likewise
    /// The author's choice: each bisected edge's midpoint, first to last, in texels, on a repeated axis within the map.
    /// No two lie in one texel.
    std::vector<glm::dvec2> midpoints;

    /// Number of a midpoint's entry: row * columns + column.
    std::size_t entry(const glm::dvec2& midpoint) const {
        return static_cast<std::size_t>(midpoint.y) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(midpoint.x);
    }
};

/// Each entry's values, 0 where no edge is bisected.
struct DerivedRanks {
    std::vector<EntryRange> ranks, bounds, radii;
    EntryRange highest_bound_threshold;
    bool shared = false;  ///< two edges have one midpoint, a whole period apart: nothing is derived
    std::string fault;    ///< of the midpoints, in words; empty: none
};

/// Derives a Rank Table by bisecting the base triangles at the given midpoints.
DerivedRanks derive_ranks(const Map& map, const RankSource& source);

}  // namespace tessera::golden
