#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "golden/height_tests/height_test.h"

namespace tessera::golden {

/// An entry of the Curvature Table (4.8) for a square of 2^l texels, in codes: | xx u^2 + xy u v + yy v^2 | is the
/// distance of the midpoint of an edge (u, v) 2^l from its chord, `rest` the root mean square of the remaining
/// deviation of the map. All are multiples of `unit`.
struct Curvature {
    double xx = 0, xy = 0, yy = 0, rest = 0;
    double unit = 0;
};

/// Levels l = 2, 3, ... in succession, each with its rows from the bottom and a cell every 2^(l - 1) texels.
struct CurvatureTable {
    std::int64_t columns = 0, rows = 0;  ///< texels covered
    std::vector<Curvature> cells;
};

/// Section 4.8. value: codes times texels.
class CurvatureTest : public HeightTest {
  public:
    /// The table may cover more than the map. threshold: codes times texels.
    CurvatureTest(CurvatureTable table, double threshold) : table_(std::move(table)), threshold_(threshold) {}

    const CurvatureTable& table() const { return table_; }
    double threshold() const { return threshold_; }
    /// The cell nearest to the texel that contains t. level: from 2 to the table's highest.
    Curvature cell(const glm::dvec2& t, int level, const Map& map) const;
    Verdict decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                   const Parameters& parameters) const override;

  private:
    CurvatureTable table_;
    double threshold_;
};

/// A cell of the Curvature Table (ALGORITHM.md 4.8 and section 6), before rounding; `unit` is 0. reach: half the side of
/// its square, in texels. column, row: of its centre's texel, which may lie beyond a clamped map.
Curvature fit_curvature(const Map& map, std::int64_t column, std::int64_t row, std::int64_t reach);

}  // namespace tessera::golden
