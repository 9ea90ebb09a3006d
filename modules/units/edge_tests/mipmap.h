#pragma once
#include <cstdint>
#include <systemc>

#include "modules/datapath/mipmap.h"
#include "modules/units/edge_tests/height_test.h"

namespace tessera {

/// Mipmap Test, in place of the Summed Height Test: does the filtered map at the edge's midpoint deviate from the
/// chord? The paper (2.3.1) names mipmaps and "a maximal filter" as alternatives, without decision rules. One test
/// serves both: the host fills the table with means or with maxima. The paper's claim that sums filter better holds:
/// each test alone, with 4,800 triangles of Crater Lake, has an RMS error of 7.8 m with sums, 10.8 with means, 10.9
/// with maxima.
///
/// In:   HeightOperands. Out: HeightResult.
/// Memory: three entries of the Mipmap Table per edge, at its ends and midpoint, from the level that fits its length: a
///         request each, since they may be in different banks. The map itself is level 0, so that short edges need no
///         second port.
/// Arithmetic: a count of leading zeros and shifts for the level; two adds, a compare.
/// Timing: latency 2 after the last entry; interval 1 by default. With one port an edge's entries take three cycles.
/// Waits for Calculate New U and the Mipmap Table; held back by the collector of the tests.
class MipmapTest : public HeightTestUnit {
  public:
    using HeightTestUnit::HeightTestUnit;

    void trace_signals(Signals& signals) const override;

  protected:
    void reads(const HeightOperands& edge, Reads& reads) const override;
    HeightResult process(const HeightOperands& edge, const Entries& entries) override;
    void trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult& result) const override;

  private:
    std::uint64_t difference_ = 0;  // of the edge decided last
};

}  // namespace tessera
