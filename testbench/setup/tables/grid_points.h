#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "modules/datapath/format.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera {

/// The corners of a triangle over a map: texture coordinates, on a repeated axis possibly periods away.
using TextureTriangle = std::array<datapath::TexCoord, 3>;

/// A texel centre that a triangle covers. part[k] / whole is its barycentric coordinate of corner k, exactly.
struct GridPoint {
    std::uint32_t column = 0, row = 0;  ///< within the map
    std::array<std::int64_t, 3> part{};

    bool is_on_an_edge() const { return part[0] == 0 || part[1] == 0 || part[2] == 0; }
};

/// The grid points of the map (texel centres) covered by a triangle, borders included. Exact.
class GridPoints {
  public:
    GridPoints(const TextureTriangle& triangle, const datapath::MapGeometry& map, const datapath::Formats& formats)
        : map_(map), half_(std::int64_t{1} << formats.texture.fraction) {
        for (std::size_t k = 0; k < 3; ++k) {
            x_[k] = 2 * std::int64_t{triangle[k].u};
            y_[k] = 2 * std::int64_t{triangle[k].v};
        }
        whole_ = (x_[1] - x_[0]) * (y_[2] - y_[0]) - (x_[2] - x_[0]) * (y_[1] - y_[0]);
        const std::int64_t winding = whole_ < 0 ? -1 : 1;
        whole_ *= winding;
        for (std::size_t k = 0; k < 3; ++k) {
            along_u_[k] = winding * (y_[(k + 1) % 3] - y_[(k + 2) % 3]);
            along_v_[k] = winding * (x_[(k + 2) % 3] - x_[(k + 1) % 3]);
        }
    }

    /// Twice the triangle's area, in squares of half an LSB of t; 0 if it has no area, and then there are no points.
    std::int64_t whole() const { return whole_; }

    template <class Visit>
    void for_each(Visit&& visit) const {
        if (whole_ == 0)
            return;
        const Span rows = covered(y_, map_.height, map_.address_v);
        for (std::int64_t row = rows.first; row <= rows.last; ++row)
            visit_row(row, visit);
    }

  private:
    struct Span {
        std::int64_t first, last;
    };

    static std::int64_t floor_of(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
    static std::int64_t ceiling_of(std::int64_t a, std::int64_t b) { return -floor_of(-a, b); }
    std::int64_t centre(std::int64_t index) const { return (2 * index + 1) * half_; }

    Span covered(const std::array<std::int64_t, 3>& corners, std::uint32_t size, datapath::AddressMode mode) const {
        const auto [least, most] = std::minmax({corners[0], corners[1], corners[2]});
        const std::int64_t last = floor_of(most - half_, 2 * half_);
        return {ceiling_of(least - half_, 2 * half_),
                mode == datapath::AddressMode::clamp ? std::min(last, std::int64_t{size} - 1) : last};
    }

    /// part[k] is part_at_0[k] + column * step of along_u_[k], and not negative inside.
    template <class Visit>
    void visit_row(std::int64_t row, Visit& visit) const {
        Span columns = covered(x_, map_.width, map_.address_u);
        std::array<std::int64_t, 3> at_0{}, step{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            at_0[k] = along_u_[k] * (centre(0) - x_[next]) + along_v_[k] * (centre(row) - y_[next]);
            step[k] = along_u_[k] * 2 * half_;
            if (step[k] > 0)
                columns.first = std::max(columns.first, ceiling_of(-at_0[k], step[k]));
            else if (step[k] < 0)
                columns.last = std::min(columns.last, floor_of(at_0[k], -step[k]));
            else if (at_0[k] < 0)
                return;
        }
        GridPoint point;
        point.row = datapath::texel_index(static_cast<std::uint32_t>(row), map_.height, map_.address_v);
        for (std::int64_t column = columns.first; column <= columns.last; ++column) {
            point.column = datapath::texel_index(static_cast<std::uint32_t>(column), map_.width, map_.address_u);
            for (std::size_t k = 0; k < 3; ++k)
                point.part[k] = at_0[k] + column * step[k];
            visit(point);
        }
    }

    datapath::MapGeometry map_;
    std::int64_t half_;  // a texel is 2 half_ wide, in half LSBs
    std::int64_t whole_ = 0;
    std::array<std::int64_t, 3> x_{}, y_{}, along_u_{}, along_v_{};
};

}  // namespace tessera
