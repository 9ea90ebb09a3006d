#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "golden/height_tests/height_test.h"

namespace range_test {

/// The test in double precision, from the map alone: it shares nothing with the hardware's files.
class GoldenRange : public tessera::golden::HeightTest {
  public:
    struct Range {
        double lowest, highest;
    };

    /// threshold: codes.
    GoldenRange(const tessera::golden::Map& map, double threshold) : threshold_(threshold) {
        for (std::int64_t side = 1;; side *= 2) {
            const std::int64_t columns = (map.width() + side - 1) / side, rows = (map.height() + side - 1) / side;
            std::vector<Range>& level = levels_.emplace_back();
            for (std::int64_t k = 0; k < columns * rows; ++k)
                level.push_back(range_of(map, k % columns * side, k / columns * side, side));
            if (columns == 1 && rows == 1)
                return;
        }
    }

    double threshold() const { return threshold_; }
    const std::vector<std::vector<Range>>& levels() const { return levels_; }

    Verdict decide(const tessera::golden::Vertex& i, const tessera::golden::Vertex& j, const tessera::golden::Vertex& m,
                   const tessera::golden::Map& map, const tessera::golden::Parameters&) const override {
        const glm::dvec2 d = glm::abs(i.texture - j.texture);
        const double half = std::max(d.x, d.y) / 2;
        std::size_t level = 0;
        while (level + 1 < levels_.size() && std::exp2(level + 1) <= half)
            ++level;
        const std::int64_t side = std::int64_t{1} << level, columns = (map.width() + side - 1) / side;
        Range all{HUGE_VAL, -HUGE_VAL};
        for (const glm::dvec2& t : {i.texture, j.texture, m.texture}) {
            const auto [x, y] = map.entry(t, map.width(), map.height());
            const Range& block = levels_[level][static_cast<std::size_t>(y / side * columns + x / side)];
            all = {std::min(all.lowest, block.lowest), std::max(all.highest, block.highest)};
        }
        const double range = all.highest - all.lowest;
        return {range > threshold_, range, threshold_, 0};
    }

  private:
    static Range range_of(const tessera::golden::Map& map, std::int64_t left, std::int64_t bottom, std::int64_t side) {
        Range range{HUGE_VAL, -HUGE_VAL};
        for (std::int64_t y = bottom; y < std::min<std::int64_t>(bottom + side, map.height()); ++y)
            for (std::int64_t x = left; x < std::min<std::int64_t>(left + side, map.width()); ++x) {
                const double code = map.given_code(static_cast<std::size_t>(y * map.width() + x));
                range = {std::min(range.lowest, code), std::max(range.highest, code)};
            }
        return range;
    }

    std::vector<std::vector<Range>> levels_;
    double threshold_;
};

}  // namespace range_test
