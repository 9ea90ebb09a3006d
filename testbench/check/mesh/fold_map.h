#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tessera {

/// A place in the plane: t, or P seen along an axis.
struct Place {
    std::int64_t x, y;
};

/// Where in the plane a patch may be folded: under triangles that collapsed or turned over. Anywhere else the
/// patch lies on the plane like a map, and no two of its vertices share a place. Kept in cells, so it may say
/// yes for a place nearby.
class FoldMap {
  public:
    /// Forgets all. The patch lies between these, but for rounding.
    void start(const Place& low, const Place& high) {
        low_ = low;
        cell_x_ = (high.x - low.x) / cells + 1;
        cell_y_ = (high.y - low.y) / cells + 1;
        any_ = everywhere_ = false;
    }
    /// Folded everywhere: the base triangle itself has no area.
    void add_everything() { any_ = everywhere_ = true; }
    /// The triangle a, b, c is one that collapsed or turned over.
    void add(const Place& a, const Place& b, const Place& c) {
        if (!any_)
            for (auto& row : changes_)
                row.fill(0);
        any_ = true;
        summed_ = false;
        const std::size_t x0 = column(std::min({a.x, b.x, c.x})), x1 = column(std::max({a.x, b.x, c.x})) + 1;
        const std::size_t y0 = row(std::min({a.y, b.y, c.y})), y1 = row(std::max({a.y, b.y, c.y})) + 1;
        ++changes_[y0][x0];
        --changes_[y0][x1];
        --changes_[y1][x0];
        ++changes_[y1][x1];
    }
    bool any() const { return any_; }
    /// To be asked once all triangles are in.
    bool covers(const Place& place) {
        if (!any_ || everywhere_)
            return everywhere_;
        if (!summed_)
            sum();
        return changes_[row(place.y)][column(place.x)] != 0;
    }

  private:
    static constexpr std::int64_t cells = 64;
    static constexpr std::size_t lines = cells + 1;

    std::size_t column(std::int64_t x) const {
        return static_cast<std::size_t>(std::clamp<std::int64_t>((x - low_.x) / cell_x_, 0, cells - 1));
    }
    std::size_t row(std::int64_t y) const {
        return static_cast<std::size_t>(std::clamp<std::int64_t>((y - low_.y) / cell_y_, 0, cells - 1));
    }
    /// From changes at the rectangles' corners to how many rectangles lie on a cell.
    void sum() {
        for (std::size_t y = 0; y < lines; ++y)
            for (std::size_t x = 1; x < lines; ++x)
                changes_[y][x] += changes_[y][x - 1];
        for (std::size_t y = 1; y < lines; ++y)
            for (std::size_t x = 0; x < lines; ++x)
                changes_[y][x] += changes_[y - 1][x];
        summed_ = true;
    }

    Place low_{0, 0};
    std::int64_t cell_x_ = 1, cell_y_ = 1;
    bool any_ = false, everywhere_ = false, summed_ = false;
    std::array<std::array<std::int32_t, lines>, lines> changes_{};
};

}  // namespace tessera
