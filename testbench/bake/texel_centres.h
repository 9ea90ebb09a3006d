#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace tessera {

inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Columns or rows of texels; none if last < first.
struct GridRange {
    std::int64_t first, last;
};

/// Texels whose centres, at .5, lie within [low, high].
inline GridRange grid_lines(double low, double high) {
    const auto line = [](double at) { return static_cast<std::int64_t>(std::clamp(at, -1e15, 1e15)); };
    return {line(std::ceil(low - 0.5 - 1e-9)), line(std::floor(high - 0.5 + 1e-9))};
}

/// The texels in a triangle's bounding box, widened by `margin` texels; if one range is empty, both are.
inline std::array<GridRange, 2> grid_box(const std::array<glm::dvec2, 3>& t, double margin = 0) {
    return {grid_lines(std::min({t[0].x, t[1].x, t[2].x}) - margin, std::max({t[0].x, t[1].x, t[2].x}) + margin),
            grid_lines(std::min({t[0].y, t[1].y, t[2].y}) - margin, std::max({t[0].y, t[1].y, t[2].y}) + margin)};
}

/// Calls at(x, y, b) for the texels of columns and rows whose centre lies in the triangle `t`, its border
/// included; t in texels, b the centre's barycentric coordinates. Row by row upwards. No texels for a triangle
/// without area. `margin`: also centres that lie this many texels outside an edge; b is then negative.
template <class At>
void for_texel_centres(const std::array<glm::dvec2, 3>& t, const GridRange& columns, const GridRange& rows, At&& at,
                       double margin = 0) {
    const auto [box_columns, box_rows] = grid_box(t, margin);
    const std::int64_t first_row = std::max(rows.first, box_rows.first), last_row = std::min(rows.last, box_rows.last);
    const std::int64_t first = std::max(columns.first, box_columns.first),
                       last = std::min(columns.last, box_columns.last);
    if (first_row > last_row || first > last)
        return;
    const glm::dvec2 ab = t[1] - t[0], ac = t[2] - t[0];
    const double area = cross(ab, ac);
    if (std::abs(area) < 1e-15)
        return;
    // A point on an edge must be inside one of its two triangles despite rounding.
    constexpr double rounding = -1e-9;
    const auto inside = [&](const glm::dvec2& edge) { return rounding - margin * glm::length(edge) / std::abs(area); };
    const double inside_a = inside(t[2] - t[1]), inside_b = inside(ac), inside_c = inside(ab);
    for (std::int64_t y = first_row; y <= last_row; ++y) {
        for (std::int64_t x = first; x <= last; ++x) {
            const glm::dvec2 away = glm::dvec2(x, y) + 0.5 - t[0];
            const double b = cross(away, ac) / area, c = cross(ab, away) / area;
            if (b < inside_b || c < inside_c || 1 - b - c < inside_a)
                continue;
            at(x, y, glm::dvec3(1 - b - c, b, c));
        }
    }
}

}  // namespace tessera
