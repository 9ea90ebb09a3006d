#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/height_test.h"
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
    while (std::max(map.width, map.height) > std::uint32_t{1} << level)
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
constexpr std::uint64_t mipmap_difference(const Entries& read) {
    return absolute_difference(static_cast<std::int64_t>(2 * read[2]), static_cast<std::int64_t>(read[0] + read[1]));
}

/// Bits of the Mipmap Test's threshold: those of the difference it is compared with.
constexpr int mipmap_threshold_bits(const Formats& formats) {
    return MipmapWidths{formats}.heights.bits;
}

/// MT: the difference is above the threshold.
constexpr bool mipmap_test(std::uint64_t difference, const TestParameters& parameters) {
    return difference > parameters.height_threshold();
}

/// Mipmap Test, in place of the Summed Height Test: does the filtered map at the edge's midpoint deviate from the
/// chord? The paper (2.3.1) names mipmaps and "a maximal filter" as alternatives, without decision rules. One test
/// serves both: the host fills the table with means or with maxima. The paper's claim that sums filter better holds:
/// each test alone, with 4,800 triangles of Crater Lake, has an RMS error of 7.8 m with sums, 10.8 with means, 10.9
/// with maxima.
///
/// Memory: three entries of the Mipmap Table per edge, at its ends and midpoint, from the level that fits its length: a
///         request each, since they may be in different banks. The map itself is level 0, so that short edges need no
///         second port.
/// Arithmetic: a count of leading zeros and shifts for the level; two adds, a compare.
/// Timing: with one port an edge's entries take three cycles.
class MipmapTest : public HeightTestFunctions {
  public:
    constexpr MipmapTest() : HeightTestFunctions("mipmap", 3) {
        work = "three reads";
        arithmetic = "add, compare";
        latency = 2;  // level and addresses, compare
        feature = 12;
        values = {{{"level", 4}, {"difference", 17}}};
        compared = 1;
    }

    int entry_bits(const Formats& formats) const override { return formats.displacement.bits; }
    /// Blocks of all levels, in one row.
    void shape(const Registers& r, TableLayout& table) const override {
        table.columns = static_cast<std::uint32_t>(mipmap_entries(r.map));
        table.rows = 1;
    }
    template <class Visit>
    static constexpr void visit_intermediates(const Formats& f, const Visit& visit) {
        visit("mipmap_test", MipmapWidths{f});
    }
    std::array<Threshold, 2> thresholds(const Formats& f) const override {
        return {{{"mipmap_threshold", mipmap_threshold_bits(f), false, "codes, 1 fraction bit"}}};
    }
    std::uint64_t limit(std::uint64_t, const TestParameters& tests) const override { return tests.height_threshold(); }

    void reads(const HeightEdge& edge, const Registers& r, Reads& reads) const override {
        mipmap_reads(edge.t_i, edge.t_j, edge.t_ij, r, [&](std::uint64_t address) { reads.add(address); });
    }
    void decide(const HeightEdge& edge, const Entries& entries, const Registers& r,
                HeightDecision& decision) const override {
        decision.values[0] = static_cast<unsigned>(mipmap_level(edge.t_i, edge.t_j, r.map, r.formats));
        decision.values[1] = mipmap_difference(entries);
        decision.asks = mipmap_test(decision.values[1], r.tests);
    }
};

}  // namespace tessera::datapath
