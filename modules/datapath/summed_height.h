#pragma once
#include <cstdint>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/height_test.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/rectangle.h"

namespace tessera::datapath {

/// Summed Height Test (paper figure 8, 2.3, 3.1.3): does the average height around the midpoint differ from that
/// around the ends?
///
/// Memory: three rectangles per edge in the Summed Height Table, four reads each; up to nine where a rectangle wraps
///         around a repeated map. A rectangle is one request.
///         In a design whose vertices carry their displacement codes (Formats::codes) the sums over rectangles of one
///         texel are codes: those of the edge's ends, and for its midpoint one read of the displacement map. Edges of a
///         base triangle, whose vertices are displaced while they are tested, read the table. (Decision: reading
///         all three codes would save the vertices' bits, but takes three entries from ports that Displace Vertex needs
///         for every midpoint.)
/// Arithmetic: subtract, shift, add, compare; sums modulo 2^n. With the area threshold two multiplications.
/// Timing: with one port a rectangle takes four cycles, an edge 12, a triangle 36.
class SummedHeightTest : public HeightTestFunctions {
  public:
    constexpr SummedHeightTest() : HeightTestFunctions("summed_height", 3) {
        work = "three rectangles, twelve reads";
        arithmetic = "add, compare";
        latency = 3;  // differences, addresses, compare; all counted after the last entry
        rectangles = true;
        codes = 1;
        values = {{{"width", 16},
                   {"height", 16},
                   {"sum_i", 48},
                   {"sum_j", 48},
                   {"sum_ij", 48},
                   {"difference", 64},
                   {"limit", 64}}};
        compared = 5;
    }

    int entry_bits(const Formats& formats) const override { return formats.summed_height.bits; }
    void shape(const Registers& r, TableLayout& table) const override {
        table.columns = r.map.width + 1;
        table.rows = r.map.height + 1;
    }
    bool reads_codes(const Formats& formats) const override { return formats.codes; }
    Multiplications multiplications(const Registers& r) const override {
        return r.tests.summed_height_unit == SummedHeightUnit::area ? summed_height_limit_multiplications(r.formats)
                                                                    : Multiplications();
    }

    std::array<Threshold, 2> thresholds(const Formats&) const override {
        return {{{"summed_height_threshold", summed_height_threshold_bits, false,
                  "sum: four times the threshold, in codes; area: in codes"}}};
    }
    std::uint64_t limit(std::uint64_t area, const TestParameters& tests) const override {
        return summed_height_limit({static_cast<std::uint32_t>(area), 1}, tests);
    }
    std::uint64_t weight(const HeightDecision& decision) const override {
        return decision.values[0] * decision.values[1];
    }

    void reads(const HeightEdge& edge, const Registers& r, Reads& reads) const override {
        const RectangleSize size = rectangle_size(edge.t_i, edge.t_j, r.map, r.formats);
        if (has_codes(edge, size, r.formats)) {
            reads.through(1);
            reads.add(texel_address(edge.t_ij, r.displacement_map, r.map, r.formats));
            return;
        }
        for (const TexCoord& centre : {edge.t_i, edge.t_j, edge.t_ij}) {
            reads.add_request();
            rectangle_entries(centred_rectangle(centre, size, r.map, r.formats), r.map, r.height_table,
                              [&](std::uint64_t address, bool) { reads.add_entry(address); });
        }
    }

    void decide(const HeightEdge& edge, const Entries& entries, const Registers& r,
                HeightDecision& decision) const override {
        const RectangleSize size = rectangle_size(edge.t_i, edge.t_j, r.map, r.formats);
        std::uint64_t* const sums = &decision.values[2];
        if (has_codes(edge, size, r.formats)) {
            sums[0] = edge.code_i;
            sums[1] = edge.code_j;
            sums[2] = entries[0];
        } else {
            unsigned sum = 0, next = 0;
            for (const TexCoord& centre : {edge.t_i, edge.t_j, edge.t_ij})
                sums[sum++] = rectangle_sum(centred_rectangle(centre, size, r.map, r.formats), r.map, r.height_table,
                                            r.formats, [&](std::uint64_t) { return entries[next++]; });
        }
        decision.values[0] = size.width;
        decision.values[1] = size.height;
        decision.values[5] = summed_height_difference(sums[0], sums[1], sums[2]);
        decision.values[6] = limit(weight(decision), r.tests);
        decision.asks = summed_height_test(sums[0], sums[1], sums[2], size, r.tests);
    }

  private:
    /// Whether the sums are codes: those of the edge's ends, and the code at its midpoint.
    static bool has_codes(const HeightEdge& edge, const RectangleSize& size, const Formats& formats) {
        return formats.codes && edge.codes_known && size.is_one_texel();
    }
};

}  // namespace tessera::datapath
