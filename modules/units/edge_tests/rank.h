#pragma once
#include <systemc>

#include "modules/datapath/rank_view.h"
#include "modules/units/edge_tests/height_test.h"

namespace tessera {

/// Rank Test, in place of the Summed Height Test: does the mesh need the edge's midpoint? The host has ranked every
/// point of the base mesh's lattice beforehand.
///
/// (Decision: one read and one threshold instead of twelve and two. From 24 base triangles the RMS error is below that
/// of as many triangles by the paper's tests with tuned thresholds. In the view-dependent variant the distances come
/// with the View Test's result, so that this test follows it and needs `test_order` cheap_first: with the tests in
/// parallel, a stream from one to the other would make one wait.)
///
/// In:   HeightOperands. Out: HeightResult, with the rank, by which the `greatest_rank` cut chooses.
/// Memory: one entry of the Rank Table per edge of even length: a rank, a bound, or both. In the view-dependent variant
///       (Formats::distances) a bound comes with a radius.
/// Arithmetic: two subtractions, an OR of their lowest bits, two compares. View-dependent also one subtraction, two
///       leading-zero counts, three shifts and two adds.
/// Timing: latency 1 after the entry; interval 1 by default.
/// Waits for Calculate New U and the Rank Table; held back by the collector of the tests.
class RankTest : public HeightTestUnit {
  public:
    using HeightTestUnit::HeightTestUnit;

    void trace_signals(Signals& signals) const override;

  protected:
    void reads(const HeightOperands& edge, Reads& reads) const override;
    HeightResult process(const HeightOperands& edge, const Entries& entries) override;
    void trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult& result) const override;

  private:
    bool may_split(const HeightOperands& edge) const;

    datapath::RankEntry entry_;  // of the edge decided last
};

}  // namespace tessera
