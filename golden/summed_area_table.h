#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::golden {

/// Texels [x, x + width) x [y, y + height); y upwards, as v.
struct Rectangle {
    std::int64_t x = 0, y = 0, width = 1, height = 1;
};

/// Summed-area table (Crow 1984; ALGORITHM.md section 2) of a map of integer codes.
///
///     SAT(x, y)  = sum of all codes in columns < x and rows < y
///     S(r)       = SAT(tr) - SAT(tl) - SAT(br) + SAT(bl)                      (paper, equation 2)
///     periodic:    SAT(x + W, y) = SAT(x, y) + SAT(W, y), likewise in y
///
/// Exact: unsigned 64 bit arithmetic wraps, so a difference is right whenever S(r) itself fits.
class SummedAreaTable {
  public:
    SummedAreaTable(int width, int height, const std::vector<std::uint32_t>& codes)
        : width_(width), height_(height), table_(index(0, std::int64_t{height} + 1), 0) {
        for (std::int64_t y = 0; y < height_; ++y) {
            std::uint64_t row = 0;
            for (std::int64_t x = 0; x < width_; ++x) {
                row += codes[static_cast<std::size_t>(y * width_ + x)];
                table_[index(x + 1, y + 1)] = table_[index(x + 1, y)] + row;
            }
        }
    }

    /// S(r) for any position and size of r; the map is read periodically in both directions.
    std::uint64_t sum(const Rectangle& r) const {
        const std::int64_t right = r.x + r.width, top = r.y + r.height;
        return prefix(right, top) - prefix(r.x, top) - prefix(right, r.y) + prefix(r.x, r.y);
    }

  private:
    std::uint64_t prefix(std::int64_t x, std::int64_t y) const {
        if (x >= 0 && x <= width_ && y >= 0 && y <= height_)
            return table_[index(x, y)];
        const std::int64_t column = floor_modulo(x, width_), row = floor_modulo(y, height_);
        const auto periods_x = static_cast<std::uint64_t>((x - column) / width_);
        const auto periods_y = static_cast<std::uint64_t>((y - row) / height_);
        return table_[index(column, row)] + periods_x * table_[index(width_, row)] +
               periods_y * table_[index(column, height_)] + periods_x * periods_y * table_[index(width_, height_)];
    }

    static std::int64_t floor_modulo(std::int64_t a, std::int64_t n) {
        const std::int64_t remainder = a % n;
        return remainder < 0 ? remainder + n : remainder;
    }

    std::size_t index(std::int64_t x, std::int64_t y) const { return static_cast<std::size_t>(y * (width_ + 1) + x); }

    std::int64_t width_, height_;
    std::vector<std::uint64_t> table_;  // (width + 1) x (height + 1), first row and column zero
};

}  // namespace tessera::golden
