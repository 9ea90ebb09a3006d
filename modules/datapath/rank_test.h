#pragma once
#include <cstdint>

#include "modules/datapath/height_test.h"
#include "modules/datapath/rank.h"
#include "modules/datapath/rank_view.h"

namespace tessera::datapath {

/// Rank Test, in place of the Summed Height Test: does the mesh need the edge's midpoint? The host has ranked every
/// point of the base mesh's lattice beforehand.
///
/// (Decision: one read and one threshold instead of twelve and two. From 24 base triangles the RMS error is below that
/// of as many triangles by the paper's tests with tuned thresholds. In the view-dependent variant the distances come
/// with the View Test's result, so that this test follows it and needs `test_order` cheap_first: with the tests in
/// parallel, a stream from one to the other would make one wait.)
///
/// Memory: one entry of the Rank Table per edge of even length: a rank, a bound, or both. In the view-dependent variant
///       (Formats::distances) a bound comes with a radius.
/// Arithmetic: two subtractions, an OR of their lowest bits, two compares. View-dependent also one subtraction, two
///       leading-zero counts, three shifts and two adds.
class RankTest : public HeightTestFunctions {
  public:
    constexpr RankTest() : HeightTestFunctions("rank", 1) {
        work = "one read, from a table that the host makes";
        arithmetic = "compare";
        feature = 5;
        covers_more = true;
        may_read_nothing = true;
        values = {{{"rank", 16}, {"bound", 16}, {"radius", radius_bits}, {"level", 18}}};
    }

    int entry_bits(const Formats& formats) const override { return rank_entry_bits(formats); }
    void shape(const Registers& r, TableLayout& table) const override {
        table.columns = r.covered.columns;
        table.rows = r.covered.rows;
    }
    template <class Visit>
    static constexpr void visit_intermediates(const Formats& f, const Visit& visit) {
        visit("rank_test", RankWidths{f});
        visit("rank_test_in_view", RankViewWidths{f});
    }
    std::array<Threshold, 2> thresholds(const Formats& f) const override {
        const auto of = [&](const char* threshold, int entry_bits, int limit_bits) {
            return f.distances && entry_bits > 0
                       ? Threshold{threshold, limit_bits, true, "at distance 1, as a 16-bit entry"}
                       : Threshold{threshold, entry_bits, false, "an entry's format"};
        };
        return {{of("rank_threshold", f.rank_bits, rank_limit_bits),
                 of("bound_threshold", f.bound_bits, bound_limit_bits)}};
    }
    unsigned traced(const Formats& formats) const override { return formats.distances ? 4 : 2; }

    void reads(const HeightEdge& edge, const Registers& r, Reads& reads) const override {
        if (has_lattice_midpoint(edge.t_i, edge.t_j, r.formats))
            reads.add(rank_address(edge.t_ij, r.height_table, r.map, r.formats));
    }
    void decide(const HeightEdge& edge, const Entries& entries, const Registers& r,
                HeightDecision& decision) const override {
        const RankEntry entry =
            has_lattice_midpoint(edge.t_i, edge.t_j, r.formats) ? rank_entry(entries[0], r.formats) : RankEntry{};
        decision.asks = asks_by_rank(entry, edge.ends, r.tests, r.formats);
        decision.rank = ordering_rank(entry, r.formats);
        decision.values[0] = entry.rank;
        decision.values[1] = entry.bound;
        decision.values[2] = entry.radius;
        decision.values[3] = r.formats.distances ? distance_level(edge.ends.distance) : 0;
    }
};

}  // namespace tessera::datapath
