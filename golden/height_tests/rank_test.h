#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "golden/height_tests/height_test.h"

namespace tessera::golden {

/// The Rank Table (4.7): for each texel of the lattice on which the base mesh lies, the error of leaving out the
/// midpoint there, on logarithmic scales. Rows from the bottom. A list is empty if the design lacks that part.
struct RankTable {
    std::int64_t columns = 0, rows = 0;
    std::vector<std::uint16_t> ranks, bounds;
    std::vector<std::uint8_t> radii;    ///< codes; present with bounds that depend on distance
    int highest_bound_threshold = 0;    ///< largest threshold for which the bounds hold
    std::vector<glm::dvec2> midpoints;  ///< in texels, in the order of their bisection
};

/// Section 4.7.
class RankTest : public HeightTest {
  public:
    /// The table may be larger than the map.
    explicit RankTest(RankTable table) : table_(std::move(table)) {}

    const RankTable& table() const { return table_; }
    Verdict decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                   const Parameters& parameters) const override;

  private:
    RankTable table_;
};

/// That of the map's Rank Test; without one an empty table.
const RankTable& rank_table(const Map& map);

}  // namespace tessera::golden
