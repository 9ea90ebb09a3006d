#include "golden/golden_curvature.h"

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
