#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/datapath/rectangle.h"
#include "modules/units/edge_tests/height_test.h"

namespace tessera {

/// Summed Height Test (paper figure 8, 2.3, 3.1.3): does the average height around the midpoint differ from that
/// around the ends?
///
/// In:   HeightOperands. Out: HeightResult.
/// Memory: three rectangles per edge in the Summed Height Table, four reads each; up to nine where a rectangle wraps
///         around a repeated map. A rectangle is one request.
///         In a design whose vertices carry their displacement codes (Formats::codes) the sums over rectangles of one
///         texel are codes: those of the edge's ends, and for its midpoint one read of the displacement map. Edges of a
///         base triangle, whose vertices are displaced while they are tested, read the table. (Decision: reading
///         all three codes would save the vertices' bits, but takes three entries from ports that Displace Vertex needs
///         for every midpoint.)
/// Arithmetic: subtract, shift, add, compare; sums modulo 2^n. With the area threshold two multiplications.
/// Timing: latency 3 after the last table entry; interval 1 by default, or that of the table reads if longer: with one
///         port a rectangle takes four cycles, an edge 12, a triangle 36.
/// Waits for Calculate New U and the Summed Height Table; held back by the collector of the tests.
class SummedHeightTest : public HeightTestUnit {
  public:
    SummedHeightTest(const sc_core::sc_module_name& name, const UnitContext& context);

    void trace_signals(Signals& signals) const override;

  protected:
    void reads(const HeightOperands& edge, Reads& reads) const override;
    HeightResult process(const HeightOperands& edge, const Entries& entries) override;
    void trace_started(Signals& signals, const HeightOperands& edge) const override;
    void trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult& result) const override;

    datapath::RectangleSize size(const HeightOperands& edge) const;
    bool has_codes(const HeightOperands& edge, const datapath::RectangleSize& its_size) const;

    std::array<std::uint64_t, 3> sums_{};  // around t_i, t_j, t_ij of the edge decided last
};

}  // namespace tessera
