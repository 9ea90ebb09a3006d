#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/format.h"
#include "modules/datapath/intermediate.h"
#include "modules/datapath/multiplications.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/rank_view.h"
#include "modules/datapath/reciprocal.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Right shift, in bits, of row_w . (P', 1) to w's format.
constexpr int view_distance_down(const Formats& f) {
    return TransformParameters::matrix_fraction + f.position.fraction - f.view_distance.fraction;
}

/// Bits of a matrix entry (-1.0 to 1.0), and of a row's fourth entry (at most 2^61).
inline constexpr int matrix_entry_bits = signed_bits(TransformParameters::matrix_fraction);
inline constexpr int matrix_offset_bits = signed_bits(61);
/// Upper bits of a numerator that the division uses.
inline constexpr int numerator_bits = 30;

struct TransformWidths : Intermediates {
    using Intermediates::Intermediates;
    int coordinate = f.position.bits - 1;  // |P'.x| is at most 2^coordinate
    Width product{"row.x * P'.x", signed_bits(TransformParameters::matrix_fraction + coordinate)};
    Width sum{"row . (P', 1)", wider(product.bits + 2, matrix_offset_bits) + 1};
    Width w{"w, rounded, before saturation", sum.bits - view_distance_down(f)};
    Width mantissa{"mantissa of w", ReciprocalWidths{f}.mantissa.bits};
    Width inverse{"reciprocal of the mantissa", ReciprocalWidths{f}.reciprocal.bits};
    Width numerator{"upper bits of the numerator", numerator_bits + 1};
    Width quotient{"numerator * reciprocal", numerator.bits + inverse.bits};
    constexpr auto all() const { return std::array{product, sum, w, mantissa, inverse, numerator, quotient}; }
};
static_assert(fits_every_format<TransformWidths>());

struct TransformNormalWidths : Intermediates {
    using Intermediates::Intermediates;
    Width product{"row.x * N'.x", 2 * f.normal.bits};
    Width sum{"row . N'", product.bits + 1};
    constexpr auto all() const { return std::array{product, sum}; }
};
static_assert(fits_every_format<TransformNormalWidths>());

/// row . (P', 1), exact.
constexpr std::int64_t transform_row(const std::array<std::int64_t, 4>& row, const Position& p) {
    return row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
}

/// 2^exponent * numerator / denominator in the screen's format. The denominator is given by its inverse and scale:
/// denominator ~ mantissa * 2^scale, inverse = 2^63 / mantissa.
constexpr std::int32_t perspective_divide(std::int64_t numerator, std::uint64_t inverse, int scale, int exponent,
                                          const Format& screen, std::uint64_t& saturated) {
    if (numerator == 0)
        return 0;
    const std::uint64_t magnitude = static_cast<std::uint64_t>(numerator < 0 ? -numerator : numerator);
    const int beyond = 64 - leading_zeros(magnitude) - numerator_bits, narrow = beyond > 0 ? beyond : 0;
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

/// Transforms a displaced position from world to screen, as an existing Transform unit would (the paper assumes one):
/// the viewport is part of the matrix. The products are exact; the division is a reciprocal (relative error 2^-30.9)
/// and a multiplication by the numerator's upper 30 bits, rounded to nearest; error at most 1/2 LSB + |result| * 2^-28.
/// w is rounded to nearest in the view distance's format, which has no more fraction bits than the position's. x, y and
/// w saturate, counted. On or behind the near plane (w <= near) there is no screen position: x = y = 0 and in_front is
/// false.
constexpr ScreenPosition transform(const Position& p, const TransformParameters& parameters, const Formats& formats,
                                   Saturations& saturations) {
    const std::int64_t w = transform_row(parameters.row_w, p);
    ScreenPosition result;
    if (formats.distances)
        result.distance = eye_distance(p, parameters, formats);
    result.w = static_cast<std::int32_t>(
        saturate(round_shift(w, view_distance_down(formats)), formats.view_distance, saturations.view_distance));
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

/// Rotates a normal from world to view space, rounded to nearest.
constexpr Direction transform_normal(const Direction& n, const TransformParameters& parameters, const Formats& formats,
                                     Saturations& saturations) {
    const auto row = [&](const std::array<std::int32_t, 3>& r) {
        const std::int64_t sum = std::int64_t{r[0]} * n.x + std::int64_t{r[1]} * n.y + std::int64_t{r[2]} * n.z;
        return static_cast<std::int32_t>(
            saturate(round_shift(sum, formats.normal.fraction), formats.normal, saturations.screen_normal));
    };
    return {row(parameters.normal_rows[0]), row(parameters.normal_rows[1]), row(parameters.normal_rows[2])};
}

inline Multiplications transform_multiplications(const Formats& f) {
    const TransformWidths w{f};
    const ReciprocalWidths r{f};
    return Multiplications()
        .add(9, matrix_entry_bits, f.position.bits)
        .add(2, r.mantissa.bits, r.reciprocal.bits)
        .add(2, r.reciprocal.bits, r.correction.bits)
        .add(2, w.numerator.bits, w.inverse.bits);
}

inline Multiplications transform_normal_multiplications(const Formats& f) {
    return Multiplications().add(9, f.normal.bits, f.normal.bits);
}

}  // namespace tessera::datapath
