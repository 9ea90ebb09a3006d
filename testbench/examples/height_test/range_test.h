#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "blocks.h"
#include "modules/datapath/height_test.h"
#include "modules/datapath/map_entry.h"

namespace range_test {

using tessera::datapath::absolute_difference;
using tessera::datapath::Entries;
using tessera::datapath::entry_bytes;
using tessera::datapath::Formats;
using tessera::datapath::HeightDecision;
using tessera::datapath::HeightEdge;
using tessera::datapath::HeightTestFunctions;
using tessera::datapath::integer_part;
using tessera::datapath::Reads;
using tessera::datapath::Registers;
using tessera::datapath::TableLayout;
using tessera::datapath::TestParameters;
using tessera::datapath::TexCoord;
using tessera::datapath::texel_index;

/// Range Test, in place of the Summed Height Test: do the map's heights around an edge differ by more than a threshold?
/// The host makes a pyramid of minima and maxima.
///
/// Memory: three entries per edge, the blocks at its ends and at its midpoint, at most half as long as the edge: a request
///         each, since they may be in different banks.
/// Arithmetic: a count of leading zeros and shifts for the level; four compares, a subtraction, a compare.
/// Timing: interval 1 by default. With one port an edge's entries take three cycles.
class RangeTest : public HeightTestFunctions {
  public:
    constexpr RangeTest() : HeightTestFunctions("range", 3) {
        latency = 2;  // level and addresses, compare
        values = {{{"level", 4}, {"lowest", 16}, {"highest", 16}, {"range", 16}}};
        compared = 3;
    }

    /// The minimum lowest.
    int entry_bits(const Formats& f) const override { return 2 * f.displacement.bits; }
    void shape(const Registers& r, TableLayout& table) const override {
        table.columns = static_cast<std::uint32_t>(blocks_of(highest_level(r.map), r.map).first_entry + 1);
        table.rows = 1;
    }
    std::array<Threshold, 2> thresholds(const Formats& f) const override {
        return {{{"range_threshold", f.displacement.bits, false, "codes"}}};
    }
    std::uint64_t limit(std::uint64_t, const TestParameters& tests) const override { return tests.height_threshold(); }

    void reads(const HeightEdge& edge, const Registers& r, Reads& reads) const override {
        const int level = level_of(edge, r);
        const Blocks blocks = blocks_of(level, r.map);
        for (const TexCoord& t : {edge.t_i, edge.t_j, edge.t_ij}) {
            const std::uint32_t column =
                texel_index(integer_part(t.u, r.formats), r.map.width, r.map.address_u) >> level;
            const std::uint32_t row = texel_index(integer_part(t.v, r.formats), r.map.height, r.map.address_v) >> level;
            const std::uint64_t entry = blocks.first_entry + std::uint64_t{row} * blocks.columns + column;
            reads.add(r.height_table.base + entry * entry_bytes(entry_bits(r.formats)));
        }
    }
    void decide(const HeightEdge& edge, const Entries& entries, const Registers& r,
                HeightDecision& decision) const override {
        const int bits = r.formats.displacement.bits;
        const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
        const std::uint64_t lowest = std::min({entries[0] & mask, entries[1] & mask, entries[2] & mask});
        const std::uint64_t highest = std::max({entries[0] >> bits, entries[1] >> bits, entries[2] >> bits});
        decision.values = {static_cast<unsigned>(level_of(edge, r)), lowest, highest, highest - lowest};
        decision.asks = highest - lowest > limit(1, r.tests);
    }

  private:
    /// The highest whose blocks are at most half as long as the longer of |du| and |dv|.
    static int level_of(const HeightEdge& edge, const Registers& r) {
        const std::uint64_t length =
            std::max(absolute_difference(edge.t_i.u, edge.t_j.u), absolute_difference(edge.t_i.v, edge.t_j.v));
        int level = 0;
        while (level < highest_level(r.map) && length >> (level + 2 + r.formats.texture.fraction) != 0)
            ++level;
        return level;
    }
};

}  // namespace range_test
