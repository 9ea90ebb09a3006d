#pragma once
#include <cstdint>

#include "modules/datapath/format.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/reciprocal.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// row . (P', 1), exact: 32 x 26 bit products, 64 bit sum.
constexpr std::int64_t transform_row(const std::array<std::int64_t, 4>& row, const Position& p) {
    return row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
}

/// 2^exponent * numerator / denominator in the screen's format, denominator given as mantissa and shift:
/// denominator ~ mantissa * 2^scale, inverse = 2^63 / mantissa.
constexpr std::int32_t perspective_divide(std::int64_t numerator, std::uint64_t inverse, int scale,
                                          int exponent, const Format& screen, std::uint64_t& saturated) {
    if (numerator == 0)
        return 0;
    const std::uint64_t magnitude = static_cast<std::uint64_t>(numerator < 0 ? -numerator : numerator);
    const int narrow = 34 - leading_zeros(magnitude) > 0 ? 34 - leading_zeros(magnitude) : 0;
    const std::int64_t quotient = (numerator >> narrow) * static_cast<std::int64_t>(inverse);
    const int down = 63 + scale - narrow - exponent - screen.fraction;
    if (down > 62)
        return 0;
    if (down <= 0) {
        ++saturated;
        return static_cast<std::int32_t>(numerator < 0 ? screen.lowest : screen.highest);
    }
    return static_cast<std::int32_t>(saturate(round_shift(quotient, down), screen, saturated));
}

/// World to screen of a displaced position (the pipeline's existing Transform unit).
/// The products are exact; the division is a reciprocal (relative error 2^-30.9) and a multiplication by the
/// numerator's upper 30 bits, rounded to nearest; error at most 1/2 LSB + |result| * 2^-28. w is rounded to nearest in
/// the view distance's format, which has no more fraction bits than the position's. x, y and w saturate, counted. On or
/// behind the near plane (w <= near) there is no screen position: x = y = 0 and in_front is false.
constexpr ScreenPosition transform(const Position& p, const TransformParameters& parameters,
                                   const Formats& formats, Saturations& saturations) {
    const std::int64_t w = transform_row(parameters.row_w, p);
    ScreenPosition result;
    const int w_shift =
        TransformParameters::matrix_fraction + formats.position.fraction - formats.view_distance.fraction;
    result.w = static_cast<std::int32_t>(
        saturate(round_shift(w, w_shift), formats.view_distance, saturations.view_distance));
    if (w <= parameters.near_plane)
        return result;
    result.in_front = true;
    const int zeros = leading_zeros(static_cast<std::uint64_t>(w));
    const auto mantissa = static_cast<std::uint32_t>((static_cast<std::uint64_t>(w) << zeros) >> 32);
    const std::uint64_t inverse = reciprocal(mantissa);
    const int scale = 32 - zeros;
    result.x = perspective_divide(transform_row(parameters.row_x, p), inverse, scale, parameters.exponent,
                                  formats.screen, saturations.screen_position);
    result.y = perspective_divide(transform_row(parameters.row_y, p), inverse, scale, parameters.exponent,
                                  formats.screen, saturations.screen_position);
    return result;
}

/// World to screen of a normal: a rotation, rounded to nearest.
constexpr Direction transform_normal(const Direction& n, const TransformParameters& parameters,
                                     const Formats& formats, Saturations& saturations) {
    const auto row = [&](const std::array<std::int32_t, 3>& r) {
        const std::int64_t sum =
            std::int64_t{r[0]} * n.x + std::int64_t{r[1]} * n.y + std::int64_t{r[2]} * n.z;
        return static_cast<std::int32_t>(
            saturate(round_shift(sum, formats.normal.fraction), formats.normal, saturations.screen_normal));
    };
    return {row(parameters.normal_rows[0]), row(parameters.normal_rows[1]), row(parameters.normal_rows[2])};
}

}  // namespace tessera::datapath
