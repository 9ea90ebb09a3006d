#pragma once
#include <cstdint>
#include <systemc>

#include "modules/datapath/curvature.h"
#include "modules/units/edge_tests/height_test.h"

namespace tessera {

/// Curvature Test, in the Summed Height Test's place: how far does the map leave the edge's chord? The host has fitted a
/// quadratic to the map around each cell of a pyramid, and says how much that leaves.
///
/// In:   HeightOperands. Out: HeightResult.
/// Memory: one entry an edge of the Curvature Table, of the level of the edge's length. Of an edge of at most two texels
///         the displacement map instead: the codes of its ends and of its midpoint, in one request, through the map's
///         second side (table_memory.h); behind a cache, which Displace Vertex reads too.
/// Arithmetic: a count of leading zeros and shifts for the level; three products of 4 x 4 bits, three of 8 x 7, their sum,
///         a shift, a compare.
/// Timing: latency 4 after the last entry; interval 1 by default. With one port a short edge's codes take three cycles.
/// Waits for Calculate New U, the Curvature Table and the displacement map; held back by the collection of the tests.
class CurvatureTest : public HeightTestUnit {
  public:
    using HeightTestUnit::HeightTestUnit;

    void trace_signals(Signals& signals) const override;

  protected:
    void reads(const HeightOperands& edge, Reads& reads) const override;
    HeightResult process(const HeightOperands& edge, const Entries& entries) override;
    void trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult& result) const override;

  private:
    std::uint64_t measure_ = 0;  // of the edge decided last
};

}  // namespace tessera
