#include "golden/height_tests/summed_height_test.h"

#include <cmath>
#include <cstdint>

namespace tessera::golden {

HeightTest::Verdict SummedHeightTest::decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                                             const Parameters&) const {
    const Rectangle size = map.rectangle_size(i.texture, j.texture);
    const auto sum_about = [&](const Vertex& v) {
        return static_cast<std::int64_t>(map.sum(map.rectangle_about(v.texture, size)));
    };
    const auto difference = static_cast<double>(std::abs(2 * sum_about(m) - (sum_about(i) + sum_about(j))));
    // Section 4.2 multiplied by four, so that the left side of the comparison is exact.
    const double limit = threshold_ * (area_ ? static_cast<double>(size.width * size.height) : 4.0);
    return {difference > limit, difference, limit, 0};
}

}  // namespace tessera::golden
