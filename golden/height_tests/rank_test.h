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

/// Whether errors are measured on the surface or as seen from the eye.
enum class RankView { none, per_point, per_pixel };

/// What a Rank Test compares its entries with.
struct RankSettings {
    /// On the entries' logarithmic scales, rounded down by the test; as seen: those of entries of 16 bits, at a mean
    /// distance of 1.
    double rank_threshold = 0, bound_threshold = 0;
    int rank_bits = 0, bound_bits = 0;  ///< of the table's entries, 0 if it has none
    RankView view = RankView::none;
};

struct Scene;
/// Those of a job (section 6), whose rank_threshold is in full scale times the square root of a texel, bound_threshold in
/// full scale; as seen: both in pixels. code_rounding: the largest difference of a map's value and its code, in codes.
RankSettings on_scales(RankSettings of_job, const Scene& scene, double code_rounding);

/// Section 4.7.
class RankTest : public HeightTest {
  public:
    /// The table may be larger than the map.
    RankTest(RankTable table, const RankSettings& settings) : table_(std::move(table)), settings_(settings) {}

    const RankTable& table() const { return table_; }
    const RankSettings& settings() const { return settings_; }
    Verdict decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                   const Parameters& parameters) const override;
    bool uses_distances() const override { return settings_.view != RankView::none; }

  private:
    RankTable table_;
    RankSettings settings_;
};

}  // namespace tessera::golden
