#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/intermediate.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/multiplications.h"

namespace tessera::datapath {

/// A weight's fraction bits: those of t, and at least one, since centres of texels lie half a texel off their borders.
constexpr int weight_bits(const Formats& f) {
    return wider(f.texture.fraction, 1);
}

/// Fraction bits that an interpolated code keeps: all of them up to these. A map of 8 bits is thus as finely stepped as
/// one of 16 bits without a filter. (Decision: whole codes would show the steps of an 8-bit map; with all 24 fraction
/// bits S * code would be 72 bits wide.)
inline constexpr int most_code_fraction = 8;
constexpr int code_fraction(const Formats& f) {
    const int all = 2 * weight_bits(f);
    return f.filter == MapFilter::nearest ? 0 : all < most_code_fraction ? all : most_code_fraction;
}

/// Of a code, which is unsigned, or a normal's component. Rounded to nearest, neither leaves its texels' range.
struct BilinearWidths : Intermediates {
    using Intermediates::Intermediates;
    int integer = f.texture.bits - 1 - f.texture.fraction;
    int value = wider(f.displacement.bits + 1, f.normal.bits);  // including a sign
    int difference = wider(f.displacement.bits, f.normal.bits) + 1;
    Width place{"t - 1/2", integer + weight_bits(f) + 1};
    Width columns{"difference of two texels", difference};
    Width row{"within a row", value + weight_bits(f)};
    Width rows{"difference of two rows", difference + weight_bits(f)};
    Width product{"difference times a weight", difference + 2 * weight_bits(f)};
    Width sum{"between the rows, before rounding", value + 2 * weight_bits(f)};
    constexpr auto all() const { return std::array{place, columns, row, rows, product, sum}; }
};
static_assert(fits_every_format<BilinearWidths>());

/// t - 1/2 on one axis, with weight_bits fraction bits: the integer part is the index of the texel whose centre is the
/// last one up to t, -1 before the first centre; the fraction is the next texel's weight.
constexpr std::int64_t place_between_centres(std::uint32_t coordinate, const Formats& formats) {
    const int bits = weight_bits(formats);
    return (std::int64_t{coordinate} << (bits - formats.texture.fraction)) - (std::int64_t{1} << (bits - 1));
}

/// Weights of the second column and the second row of the four texels around t, of 2^weight_bits.
struct BilinearWeights {
    std::int64_t column = 0, row = 0;
};
constexpr BilinearWeights bilinear_weights(const TexCoord& t, const Formats& formats) {
    const std::int64_t mask = (std::int64_t{1} << weight_bits(formats)) - 1;
    return {place_between_centres(t.u, formats) & mask, place_between_centres(t.v, formats) & mask};
}

/// Between the values of the four texels around t, lower row first, with `fraction` fraction bits more than theirs:
///     (1 - v) ((1 - u) a + u b) + v ((1 - u) c + u d)
/// Exact, then rounded to nearest once. At a texel's centre that texel's value.
constexpr std::int64_t interpolate(const std::array<std::int64_t, 4>& texels, const BilinearWeights& weights,
                                   int fraction, const Formats& formats) {
    const int bits = weight_bits(formats);
    const auto between = [&](std::int64_t a, std::int64_t b, std::int64_t weight) {
        return a * (std::int64_t{1} << bits) + (b - a) * weight;
    };
    return round_shift(between(between(texels[0], texels[1], weights.column),
                               between(texels[2], texels[3], weights.column), weights.row),
                       2 * bits - fraction);
}

/// The table entries from which a map is read at t, in the order of the reads: calls entry(address) with the byte
/// address of the texel under t or, with a bilinear filter, of each of the four around it, lower row first. Each is
/// addressed by itself: a clamped border's texel is read twice, a repeated map's first texel lies beside its last.
template <class Entry>
constexpr void map_entries(const TexCoord& t, const TableLayout& table, const MapGeometry& map, const Formats& formats,
                           Entry&& entry) {
    if (formats.filter == MapFilter::nearest) {
        entry(texel_address(t, table, map, formats));
        return;
    }
    const auto indices = [&](std::uint32_t coordinate, std::uint32_t size, AddressMode mode) {
        const std::int64_t first = place_between_centres(coordinate, formats) >> weight_bits(formats);
        const std::uint32_t before = mode == AddressMode::clamp ? 0 : size - 1;
        return std::array{first < 0 ? before : texel_index(static_cast<std::uint32_t>(first), size, mode),
                          texel_index(static_cast<std::uint32_t>(first + 1), size, mode)};
    };
    const auto columns = indices(t.u, map.width, map.address_u), rows = indices(t.v, map.height, map.address_v);
    for (const std::uint32_t row : rows)
        for (const std::uint32_t column : columns)
            entry(table.address(column, row));
}

/// Number of these entries.
constexpr unsigned map_entry_count(const Formats& formats) {
    return formats.filter == MapFilter::nearest ? 1 : 4;
}

/// d at t, with code_fraction fraction bits; from the displacement map's entries.
constexpr std::uint32_t map_code(const TexCoord& t, const std::uint64_t* entries, const Formats& formats) {
    if (formats.filter == MapFilter::nearest)
        return static_cast<std::uint32_t>(entries[0]);
    std::array<std::int64_t, 4> codes{};
    for (std::size_t k = 0; k < 4; ++k)
        codes[k] = static_cast<std::int64_t>(entries[k]);
    return static_cast<std::uint32_t>(
        interpolate(codes, bilinear_weights(t, formats), code_fraction(formats), formats));
}

/// The code of the texel under t, which is one of the entries: vertices carry it (`one_texel_from_map`), since the
/// Summed Height Test sums texels and decides as without a filter.
constexpr std::uint16_t nearest_code(const TexCoord& t, const std::uint64_t* entries, const Formats& formats) {
    if (formats.filter == MapFilter::nearest)
        return static_cast<std::uint16_t>(entries[0]);
    const BilinearWeights weights = bilinear_weights(t, formats);
    const std::int64_t half = std::int64_t{1} << (weight_bits(formats) - 1);
    return static_cast<std::uint16_t>(entries[(weights.column < half ? 0 : 1) + (weights.row < half ? 0 : 2)]);
}

/// N_d at t, from the normal map's entries: interpolated component by component, so that its length may be less than
/// 1.0, and rounded to nearest in the normal's format. bump() normalises.
constexpr Direction map_normal(const TexCoord& t, const std::uint64_t* entries, const Formats& formats) {
    if (formats.filter == MapFilter::nearest)
        return unpack_normal(entries[0], formats.normal.bits);
    std::array<std::int64_t, 4> x{}, y{}, z{};
    for (std::size_t k = 0; k < 4; ++k) {
        const Direction n = unpack_normal(entries[k], formats.normal.bits);
        x[k] = n.x;
        y[k] = n.y;
        z[k] = n.z;
    }
    const BilinearWeights weights = bilinear_weights(t, formats);
    const auto component = [&](const std::array<std::int64_t, 4>& texels) {
        return static_cast<std::int32_t>(interpolate(texels, weights, 0, formats));
    };
    return {component(x), component(y), component(z)};
}

/// Of one value; none without a bilinear filter.
inline Multiplications interpolate_multiplications(const Formats& f) {
    const BilinearWidths w{f};
    const int weight = weight_bits(f);
    Multiplications all;
    if (map_entry_count(f) > 1)
        all.add(2, w.columns.bits, weight).add(1, w.rows.bits, weight);
    return all;
}

}  // namespace tessera::datapath
