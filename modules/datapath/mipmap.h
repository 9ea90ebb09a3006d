#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/intermediate.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// The Mipmap Test compares three heights of the map filtered to an edge's length, as the Summed Height Test compares
/// three sums: the alternative named in the paper (2.3.1), with means (Williams 1983) or maxima.
struct MipmapWidths : Intermediates {
    using Intermediates::Intermediates;
    Width difference{"abs(du), abs(dv)", f.texture.bits};
    Width heights{"2 M_ij - M_i - M_j", f.displacement.bits + 1};
    constexpr auto all() const { return std::array{difference, heights}; }
};
static_assert(fits_every_format<MipmapWidths>());

/// Blocks of 2^l x 2^l texels of one level, the last ones cut off by the map's border. Level 0 is the map itself.
struct MipmapBlocks {
    std::uint32_t columns = 0, rows = 0;
    std::uint64_t first_entry = 0;  ///< entries of the lower levels, which lie before these
};

constexpr MipmapBlocks mipmap_blocks(int level, const MapGeometry& map) {
    MipmapBlocks blocks;
    for (int l = 0;; ++l) {
        blocks.columns = ((map.width - 1) >> l) + 1;
        blocks.rows = ((map.height - 1) >> l) + 1;
        if (l == level)
            return blocks;
        blocks.first_entry += std::uint64_t{blocks.columns} * blocks.rows;
    }
}

/// The level of a single block, the table's last.
constexpr int highest_mipmap_level(const MapGeometry& map) {
    int level = 0;
    while ((std::max(map.width, map.height) - 1) >> level != 0)
        ++level;
    return level;
}

/// The number of entries of all levels.
constexpr std::uint64_t mipmap_entries(const MapGeometry& map) {
    return mipmap_blocks(highest_mipmap_level(map), map).first_entry + 1;
}

/// Level for an edge: the highest whose blocks are at most half as long as the longer of |du| and |dv|, as the Summed
/// Height Test's rectangles are; at most the map's highest.
constexpr int mipmap_level(const TexCoord& i, const TexCoord& j, const MapGeometry& map, const Formats& formats) {
    const std::uint64_t length = std::max(absolute_difference(i.u, j.u), absolute_difference(i.v, j.v));
    const int highest = highest_mipmap_level(map);
    int level = 0;
    while (level < highest && length >> (level + 2 + formats.texture.fraction) != 0)
        ++level;
    return level;
}

/// Byte address of the block that holds the texel under t; base: that of the table.
constexpr std::uint64_t mipmap_address(const TexCoord& t, int level, std::uint64_t base, const MapGeometry& map,
                                       const Formats& formats) {
    const MipmapBlocks blocks = mipmap_blocks(level, map);
    const std::uint32_t column = texel_index(integer_part(t.u, formats), map.width, map.address_u) >> level;
    const std::uint32_t row = texel_index(integer_part(t.v, formats), map.height, map.address_v) >> level;
    const std::uint64_t entry = blocks.first_entry + std::uint64_t{row} * blocks.columns + column;
    return base + entry * entry_bytes(formats.displacement.bits);
}

/// Addresses of the three entries read for an edge: for its ends, then for its midpoint.
template <class Visit>
constexpr void mipmap_reads(const TexCoord& i, const TexCoord& j, const TexCoord& ij, const Registers& r,
                            Visit&& visit) {
    const int level = mipmap_level(i, j, r.map, r.formats);
    for (const TexCoord& t : {i, j, ij})
        visit(mipmap_address(t, level, r.height_table.base, r.map, r.formats));
}

/// |2 M_ij - M_i - M_j|, from these entries: twice the height by which the midpoint deviates from the chord.
template <class Entries>
constexpr std::uint64_t mipmap_difference(const Entries& read) {
    return absolute_difference(static_cast<std::int64_t>(2 * read[2]), static_cast<std::int64_t>(read[0] + read[1]));
}

/// Bits of the Mipmap Test's threshold: those of the difference it is compared with.
constexpr int mipmap_threshold_bits(const Formats& formats) {
    return MipmapWidths{formats}.heights.bits;
}

/// MT: the difference is above the threshold.
constexpr bool mipmap_test(std::uint64_t difference, const TestParameters& parameters) {
    return difference > parameters.mipmap_threshold;
}

}  // namespace tessera::datapath
