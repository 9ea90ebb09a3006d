#include "golden/height_tests/curvature_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tessera::golden {
namespace {

// The part of a square's side that lies on the map.
double part_on_map(std::int64_t centre, std::int64_t reach, std::int64_t size, AddressMode mode) {
    std::int64_t inside = 0;
    for (std::int64_t at = centre - reach; at <= centre + reach; ++at)
        inside += mode == AddressMode::repeat || (at >= 0 && at < size) ? 1 : 0;
    return static_cast<double>(inside) / static_cast<double>(2 * reach + 1);
}

}  // namespace

Curvature CurvatureTest::cell(const glm::dvec2& t, int level, const Map& map) const {
    std::int64_t first = 0;
    for (int l = 2;; ++l) {
        const std::int64_t spacing = std::int64_t{1} << (l - 1);
        const auto nearest = [&](std::int64_t texel) { return (texel + spacing / 2) / spacing; };
        const std::int64_t columns = nearest(table_.columns - 1) + 1, rows = nearest(table_.rows - 1) + 1;
        const bool holds_all = std::max(table_.columns, table_.rows) <= 2 * spacing;
        if (l == level || holds_all) {
            const auto [x, y] = map.entry(t, table_.columns, table_.rows);
            return table_.cells[static_cast<std::size_t>(first + nearest(y) * columns + nearest(x))];
        }
        first += columns * rows;
    }
}

HeightTest::Verdict CurvatureTest::decide(const Vertex& i, const Vertex& j, const Vertex& m, const Map& map,
                                          const Parameters&) const {
    const auto verdict = [&](double curvature) { return Verdict{curvature > threshold_, curvature, threshold_, 0}; };
    const glm::dvec2 d = i.texture - j.texture;
    const double longer = std::max(std::abs(d.x), std::abs(d.y));
    int level = 1;
    while (longer > std::exp2(level))
        ++level;
    const double length = std::exp2(level);
    if (level == 1) {
        const auto code = [&](const Vertex& v) { return map.code(map.texel(v.texture)); };
        return verdict(std::abs(code(m) - (code(i) + code(j)) / 2) * length);
    }
    const Curvature c = cell(m.texture, level, map);
    const double u = std::floor(8 * std::abs(d.x) / length) / 8, v = std::floor(8 * std::abs(d.y) / length) / 8;
    const double xy = d.x * d.y < 0 ? -c.xy : c.xy;
    const auto whole_units = [&](double codes) { return std::floor(codes / c.unit) * c.unit; };
    const double bend = whole_units(std::abs(c.xx * u * u + xy * u * v + c.yy * v * v));
    return verdict((std::max(bend, c.rest) + whole_units(std::min(bend, c.rest) / 2)) * length);
}

Curvature fit_curvature(const Map& map, std::int64_t column, std::int64_t row, std::int64_t reach) {
    const double part = part_on_map(column, reach, map.width(), map.address_u()) *
                        part_on_map(row, reach, map.height(), map.address_v());
    if (part == 0)
        return {};
    const std::int64_t side = 2 * reach + 1;
    std::vector<double> codes;
    codes.reserve(static_cast<std::size_t>(side * side));
    const auto centre = [](std::int64_t texel) { return static_cast<double>(texel) + 0.5; };
    for (std::int64_t y = -reach; y <= reach; ++y)
        for (std::int64_t x = -reach; x <= reach; ++x)
            codes.push_back(map.given_code(map.texel({centre(column + x), centre(row + y)})));
    double mean_square = 0;
    for (std::int64_t x = -reach; x <= reach; ++x)
        mean_square += static_cast<double>(x * x) / static_cast<double>(side);

    // Of the orthogonal polynomials 1, x, y, x y, x^2 - mean, y^2 - mean: the coefficient of each in the fit.
    const auto values = [&](std::size_t k, double x, double y) {
        switch (k) {
            case 0: return 1.0;
            case 1: return x;
            case 2: return y;
            case 3: return x * y;
            case 4: return x * x - mean_square;
            default: return y * y - mean_square;
        }
    };
    constexpr std::size_t terms = 6;
    std::array<double, terms> coefficient{};
    const auto each = [&](auto&& visit) {
        std::size_t at = 0;
        for (std::int64_t y = -reach; y <= reach; ++y)
            for (std::int64_t x = -reach; x <= reach; ++x)
                visit(static_cast<double>(x), static_cast<double>(y), codes[at++]);
    };
    for (std::size_t k = 0; k < terms; ++k) {
        double product = 0, square = 0;
        each([&](double x, double y, double code) {
            const double value = values(k, x, y);
            product += value * code;
            square += value * value;
        });
        coefficient[k] = square > 0 ? product / square : 0;
    }
    double squared_rest = 0;
    each([&](double x, double y, double code) {
        double rest = code;
        for (std::size_t k = 0; k < terms; ++k)
            rest -= coefficient[k] * values(k, x, y);
        squared_rest += rest * rest;
    });
    // An edge across the square has its ends at a distance of `reach` from its midpoint.
    const double bend = static_cast<double>(reach * reach) * std::sqrt(part);
    return {coefficient[4] * bend, coefficient[3] * bend, coefficient[5] * bend,
            std::sqrt(squared_rest / static_cast<double>(side * side) * part), 0};
}

}  // namespace tessera::golden
