#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/rectangle.h"
#include "modules/memory/memory_port.h"
#include "modules/unit/stage.h"

namespace tessera {

/// Summed Height Test (paper figure 8, 2.3, 3.1.3): does the average height around the midpoint differ from that
/// around the ends?
///
/// In:   edges, with t_i, t_j; edges[k].texture. Out: summed_height_bit of edges[k].tests.
/// Memory: three rectangles an edge on the Summed Height Table, four reads each; up to nine where a rectangle wraps
///         around a repeated map. A rectangle is one request.
/// Arithmetic: subtract, shift, add, compare; sums modulo 2^n. With the area threshold two multiplications.
/// Timing: one edge per interval, latency 3, interval 1 by default, plus the table reads: with one port a rectangle
///         takes four cycles, an edge 12, a triangle 36.
/// Waits for Calculate New U and the Summed Height Table; held back by the collection of the tests.
class SummedHeightTest final : public Stage<Work> {
  public:
    StreamInput<Work> input{"input"};
    StreamOutput<Work> output{"output"};
    MemoryPort summed_height_table;

    SummedHeightTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                     const Timing& timing, bool use_direct_memory);

    void show(Signals& signals) const override;

  private:
    void reads(const Work& edge, Reads& reads) const override;
    Work process(const Work& edge, const Entries& entries) override;
    void trace_started(Signals& signals, const Work& edge) const override;
    void trace_processed(Signals& signals, const Work& edge, const Work& result) const override;

    datapath::RectangleSize size(const Work& edge) const;
    datapath::RectangleReads rectangle(const Work& edge, const datapath::RectangleSize& size,
                                       unsigned number) const;

    const datapath::Registers& registers_;
    std::array<std::uint64_t, 3> sums_{};  // of the edge decided last
};

}  // namespace tessera
