#pragma once
#include <cstdint>
#include <systemc>

#include "modules/datapath/curvature.h"
#include "modules/units/edge_tests/height_test.h"

namespace tessera {

/// Curvature Test, in place of the Summed Height Test: how far does the map deviate from the edge's chord? The host has
/// fitted a quadratic to the map around each cell of a pyramid; an entry also holds what the fit leaves over.
/// (Decision: a feature narrower than an edge can lie beside all of the Summed Height Test's rectangles. A fit detects
/// it, with one read instead of twelve.) Unlike ranks, cells know of no lattice: the Tex Coord and Generation Tests end
/// the recursion, and all edges that request a split are cut at once.
///
/// In:   HeightOperands. Out: HeightResult.
/// Memory: one entry of the Curvature Table per edge, from the level that matches the edge's length. For an edge of at
///         most two texels the displacement map instead: the codes of its ends and of its midpoint, which is not yet
///         displaced in any design, in one request, through the map's second side (table_memory.h), which has the ports
///         and banks of the first, or, if the map has a cache, through Displace Vertex's cache.
/// Arithmetic: a count of leading zeros and shifts for the level; three products of 4 x 4 bits, three of 8 x 7, their
///         sum, a shift, a compare.
/// Timing: latency 4 after the last entry; interval 1 by default. With one port a short edge's codes take three cycles.
/// Waits for Calculate New U, the Curvature Table and the displacement map; held back by the collector of the tests.
class CurvatureTest : public HeightTestUnit {
  public:
    CurvatureTest(const sc_core::sc_module_name& name, const UnitContext& context);

    void trace_signals(Signals& signals) const override;

  protected:
    void reads(const HeightOperands& edge, Reads& reads) const override;
    HeightResult process(const HeightOperands& edge, const Entries& entries) override;
    void trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult& result) const override;

  private:
    std::uint64_t measure_ = 0;  // of the edge decided last
};

}  // namespace tessera
