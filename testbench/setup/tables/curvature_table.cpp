#include "testbench/setup/tables/curvature_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "testbench/setup/tables/table_extent.h"

namespace tessera {

namespace {

using datapath::AddressMode;

/// Sums over a square of n x n codes h; x and y run from -reach to reach. Exact: sides have at most 2^13 texels.
struct SquareSums {
    std::int64_t h = 0, hh = 0, xh = 0, yh = 0, xxh = 0, yyh = 0, xyh = 0;
};

/// A quadratic, given by its midpoint deviations from border-to-border chords, and its residual, in codes.
struct Bend {
    double xx = 0, xy = 0, yy = 0, rest = 0;
};

/// The squares of one level, with 2 * reach + 1 texels per side.
class Squares {
  public:
    Squares(const QuantisedMap& map, std::int64_t reach)
        : map_(map), reach_(reach), side_(2.0 * static_cast<double>(reach) + 1) {
        double fourth = 0;
        for (std::int64_t x = -reach; x <= reach; ++x) {
            squares_ += static_cast<double>(x * x);
            fourth += static_cast<double>(x * x) * static_cast<double>(x * x);
        }
        spread_ = side_ * fourth - squares_ * squares_;
    }

    Bend bend_at(std::uint32_t column, std::uint32_t row) const {
        const double share = share_on_map(column, map_.geometry.width, map_.geometry.address_u) *
                             share_on_map(row, map_.geometry.height, map_.geometry.address_v);
        if (share == 0)
            return {};
        Bend bend = bend_of(sums_at(column, row));
        for (double* value : {&bend.xx, &bend.xy, &bend.yy, &bend.rest})
            *value *= std::sqrt(share);
        return bend;
    }

  private:
    /// The polynomials 1, x, y, xy, x^2 - mean and y^2 - mean are orthogonal over the square.
    Bend bend_of(const SquareSums& sums) const {
        const double count = side_ * side_, mean = squares_ / side_, h = static_cast<double>(sums.h);
        const double xx = static_cast<double>(sums.xxh) - mean * h, yy = static_cast<double>(sums.yyh) - mean * h;
        const double x = static_cast<double>(sums.xh), y = static_cast<double>(sums.yh);
        const double xy = static_cast<double>(sums.xyh);
        const double rest = static_cast<double>(sums.hh) - h * h / count - (x * x + y * y) / (side_ * squares_) -
                            xy * xy / (squares_ * squares_) - (xx * xx + yy * yy) / spread_;
        const double end = static_cast<double>(reach_ * reach_);
        return {xx / spread_ * end, xy / (squares_ * squares_) * end, yy / spread_ * end,
                std::sqrt(std::max(0.0, rest) / count)};
    }

    SquareSums sums_at(std::uint32_t column, std::uint32_t row) const {
        SquareSums sums;
        for (std::int64_t y = -reach_; y <= reach_; ++y) {
            const std::size_t line =
                index(row + y, map_.geometry.height, map_.geometry.address_v) * map_.geometry.width;
            std::int64_t h = 0, xh = 0;
            for (std::int64_t x = -reach_; x <= reach_; ++x) {
                const std::int64_t code =
                    map_.codes[line + index(column + x, map_.geometry.width, map_.geometry.address_u)];
                h += code;
                xh += x * code;
                sums.xxh += x * x * code;
                sums.hh += code * code;
            }
            sums.h += h;
            sums.xh += xh;
            sums.yh += y * h;
            sums.xyh += y * xh;
            sums.yyh += y * y * h;
        }
        return sums;
    }

    static std::size_t index(std::int64_t texel, std::int64_t size, AddressMode mode) {
        if (mode == AddressMode::clamp)
            return static_cast<std::size_t>(std::clamp<std::int64_t>(texel, 0, size - 1));
        return static_cast<std::size_t>((texel % size + size) % size);
    }

    double share_on_map(std::int64_t centre, std::int64_t size, AddressMode mode) const {
        if (mode == AddressMode::repeat)
            return 1;
        const std::int64_t first = std::max<std::int64_t>(centre - reach_, 0);
        const std::int64_t last = std::min(centre + reach_, size - 1);
        return static_cast<double>(std::max<std::int64_t>(last - first + 1, 0)) / side_;
    }

    const QuantisedMap& map_;
    std::int64_t reach_;
    double side_;
    double squares_ = 0;  // sum of x^2 over a row
    double spread_ = 0;   // sum of (x^2 - mean)^2 over the square
};

/// Uses the least exponent at which all four values fit; rounds to nearest.
datapath::CurvatureEntry rounded(const Bend& bend) {
    datapath::CurvatureEntry entry;
    const auto in_units = [&](double codes) {
        return std::nearbyint(std::ldexp(codes, datapath::curvature_fraction - entry.exponent));
    };
    const double largest = std::max({std::abs(bend.xx), std::abs(bend.xy), std::abs(bend.yy)});
    while (entry.exponent < datapath::largest_curvature_exponent &&
           (in_units(largest) > 127 || in_units(bend.rest) > 255))
        ++entry.exponent;
    const auto of = [&](double codes) { return static_cast<std::int32_t>(std::clamp(in_units(codes), -127.0, 127.0)); };
    entry.xx = of(bend.xx);
    entry.xy = of(bend.xy);
    entry.yy = of(bend.yy);
    entry.rest = static_cast<std::uint32_t>(std::min(in_units(bend.rest), 255.0));
    return entry;
}

}  // namespace

CurvatureTable make_curvature_table(const QuantisedMap& map, const std::vector<TextureTriangle>& base,
                                    const datapath::Formats& formats) {
    CurvatureTable table;
    table.covered = table_extent(map.geometry, base, formats);
    const int highest = datapath::highest_curvature_level(table.covered);
    for (int level = datapath::least_curvature_level; level <= highest; ++level) {
        const datapath::CurvatureCells cells = datapath::curvature_cells(level, table.covered);
        const Squares squares(map, std::int64_t{1} << (level - 1));
        for (std::uint32_t row = 0; row < cells.rows; ++row) {
            for (std::uint32_t column = 0; column < cells.columns; ++column)
                table.entries.push_back(
                    datapath::pack_curvature(rounded(squares.bend_at(column << (level - 1), row << (level - 1)))));
        }
    }
    return table;
}

}  // namespace tessera
