#include "golden/height_tests/mipmap_test.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tessera::golden {

MipmapTest::MipmapTest(const Map& map, MipmapFilter filter, double threshold) : threshold_(threshold) {
    const std::int64_t width = map.width(), height = map.height();
    for (std::int64_t side = 1;; side *= 2) {
        const std::int64_t columns = (width + side - 1) / side, rows = (height + side - 1) / side;
        std::vector<double>& level = levels_.emplace_back();
        for (std::int64_t k = 0; k < columns * rows; ++k) {
            const std::int64_t left = k % columns * side, bottom = k / columns * side;
            const std::int64_t right = std::min(left + side, width);
            const std::int64_t top = std::min(bottom + side, height);
            double sum = 0, highest = 0;
            for (std::int64_t y = bottom; y < top; ++y) {
                for (std::int64_t x = left; x < right; ++x) {
                    const double code = map.given_code(static_cast<std::size_t>(y * width + x));
                    sum += code;
                    highest = std::max(highest, code);
                }
            }
            const double texels = static_cast<double>((right - left) * (top - bottom));
            level.push_back(filter == MipmapFilter::maximum ? highest : std::floor(sum / texels + 0.5));
        }
        if (columns == 1 && rows == 1)
            return;
    }
}

double MipmapTest::height(const glm::dvec2& t, int level, const Map& map) const {
    const std::int64_t side = std::int64_t{1} << level, columns = (map.width() + side - 1) / side;
    const auto [x, y] = map.entry(t, map.width(), map.height());
    return levels_[static_cast<std::size_t>(level)][static_cast<std::size_t>(y / side * columns + x / side)];
}

HeightTest::Verdict MipmapTest::decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                                       const Parameters&) const {
    const glm::dvec2 d = glm::abs(i.texture - j.texture);
    const double half = std::max(d.x, d.y) / 2;
    const int highest = static_cast<int>(levels_.size()) - 1;
    int level = 0;
    while (level < highest && std::exp2(level + 1) <= half)
        ++level;
    const auto filtered = [&](const Vertex& v) { return height(v.texture, level, map); };
    const double deviation = std::abs(filtered(m) - (filtered(i) + filtered(j)) / 2);
    return {deviation > threshold_, deviation, threshold_, 0};
}

}  // namespace tessera::golden
