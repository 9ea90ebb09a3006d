#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/intermediate.h"
#include "modules/datapath/map_address.h"

namespace tessera::datapath {

/// Width and height, in whole texels, of each of an edge's three rectangles.
struct RectangleSize {
    std::uint32_t width = 1;
    std::uint32_t height = 1;

    constexpr bool is_one_texel() const { return width == 1 && height == 1; }
};

/// t ranges from 0 to 2^integer texels, and so does |du|; a rectangle is at most half as wide.
struct RectangleWidths : Intermediates {
    using Intermediates::Intermediates;
    int integer = f.texture.bits - 1 - f.texture.fraction;
    Width difference{"abs(du), abs(dv)", f.texture.bits};
    Width width{"width", wider(integer, 1)};
    Width height{"height", wider(integer - 1, 1)};
    Width first{"first column, before it is shifted inside", integer + 2};
    Width last{"last column", integer + 1};
    Width sum{"S(r), modulo", f.summed_height.bits};
    constexpr auto all() const { return std::array{difference, width, height, first, last, sum}; }
};
static_assert(fits_every_format<RectangleWidths>());

/// Width |du| / 2 and height |dv| / 4, rounded down to whole texels, at least 1 and at most the map's
/// (golden/ALGORITHM.md 4.2): with empty rectangles an edge along an axis would never split. Commutative, since it uses
/// absolute differences.
constexpr RectangleSize rectangle_size(const TexCoord& a, const TexCoord& b, const MapGeometry& map,
                                       const Formats& formats) {
    const auto side = [](std::uint32_t difference, int shift, std::uint32_t size) {
        const std::uint32_t whole = difference >> shift;
        return whole < 1 ? 1 : (whole > size ? size : whole);
    };
    const std::uint32_t du = a.u > b.u ? a.u - b.u : b.u - a.u;
    const std::uint32_t dv = a.v > b.v ? a.v - b.v : b.v - a.v;
    return {side(du, formats.texture.fraction + 1, map.width), side(dv, formats.texture.fraction + 2, map.height)};
}

/// First texel of a rectangle of `extent` texels about `centre`. Clamp shifts it inside the map without clipping;
/// repeat reduces it by whole periods (first + extent may then exceed the map by less than a period).
constexpr std::uint32_t rectangle_first(std::uint32_t centre, std::uint32_t extent, std::uint32_t size,
                                        AddressMode mode) {
    const std::int64_t first = std::int64_t{centre} - (extent >> 1);
    if (mode == AddressMode::clamp) {
        const std::int64_t last = std::int64_t{size} - extent;
        return static_cast<std::uint32_t>(first < 0 ? 0 : (first > last ? last : first));
    }
    if (first >= 0)
        return first < size ? static_cast<std::uint32_t>(first) : static_cast<std::uint32_t>(first) % size;
    return static_cast<std::uint32_t>(first + size);
}

/// A rectangle of texels: columns [first_column, last_column), rows [first_row, last_row).
struct Rectangle {
    std::uint32_t first_column = 0, last_column = 0;
    std::uint32_t first_row = 0, last_row = 0;
};

constexpr Rectangle centred_rectangle(const TexCoord& t, const RectangleSize& size, const MapGeometry& map,
                                      const Formats& formats) {
    Rectangle r;
    r.first_column = rectangle_first(integer_part(t.u, formats), size.width, map.width, map.address_u);
    r.first_row = rectangle_first(integer_part(t.v, formats), size.height, map.height, map.address_v);
    r.last_column = r.first_column + size.width;
    r.last_row = r.first_row + size.height;
    return r;
}

/// Largest number of entries of a rectangle's sum: a rectangle that wraps on both axes.
constexpr unsigned most_rectangle_entries = 9;

/// Table entries of S(r) = SAT(tr) - SAT(tl) - SAT(br) + SAT(bl) modulo 2^bits (paper equation 2): calls
/// entry(address, subtracted) with the byte address of each entry, in the order of the reads.
///
/// The table has (width + 1) x (height + 1) entries; entry (x, y) is the sum of texels [0, x) x [0, y) modulo
/// 2^bits, so row 0 and column 0 are zero. Subtraction wraps correctly as long as S(r) itself fits.
/// Past the map (repeat) the table reads periodically: SAT(x + W, y) = SAT(x, y) + SAT(W, y), one more read and
/// one more add per corner and axis: four reads, or up to nine when r wraps. r begins inside the map.
template <class Entry>
constexpr void rectangle_entries(const Rectangle& r, const MapGeometry& map, const TableLayout& table, Entry&& entry) {
    const auto in_column = [&](std::uint32_t x) { return std::uint64_t{x} * table.entry_bytes; };
    const std::uint64_t first_row = table.address(0, r.first_row), first_column = in_column(r.first_column);
    const bool wraps_u = r.last_column > map.width, wraps_v = r.last_row > map.height;
    const std::uint64_t last_row = table.address(0, wraps_v ? r.last_row - map.height : r.last_row);
    const std::uint64_t last_column = in_column(wraps_u ? r.last_column - map.width : r.last_column);
    const auto right_corner = [&](std::uint64_t row, bool subtracted) {
        if (wraps_u)
            entry(row + in_column(map.width), subtracted);
        entry(row + last_column, subtracted);
    };
    if (wraps_v)
        right_corner(table.address(0, map.height), false);
    right_corner(last_row, false);
    if (wraps_v)
        entry(table.address(0, map.height) + first_column, true);
    entry(last_row + first_column, true);
    right_corner(first_row, true);
    entry(first_row + first_column, false);
}

/// S(r): `read(address)` gives the entry at a byte address.
template <class Read>
constexpr std::uint64_t rectangle_sum(const Rectangle& r, const MapGeometry& map, const TableLayout& table,
                                      const Formats& formats, Read&& read) {
    std::uint64_t sum = 0;
    rectangle_entries(r, map, table, [&](std::uint64_t address, bool subtracted) {
        sum += subtracted ? 0 - read(address) : read(address);
    });
    return sum & static_cast<std::uint64_t>(formats.summed_height.highest);
}

}  // namespace tessera::datapath
