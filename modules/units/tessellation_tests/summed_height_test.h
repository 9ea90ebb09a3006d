#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/rectangle.h"
#include "modules/memory/memory_port.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"
#include "modules/timing.h"
#include "modules/unit/table_stage.h"

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
class SummedHeightTest : public TableStage<SummedHeightTest, struct SummedHeightItem> {
  public:
    StreamInput<Work> input{"input"};
    StreamOutput<Work> output{"output"};
    MemoryPort summed_height_table;

    SummedHeightTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                     const Timing& timing, bool use_direct_memory);

    void show(Signals& signals) const override;

  private:
    friend class TableStage<SummedHeightTest, SummedHeightItem>;
    void b_transport(Work& work, sc_core::sc_time& delay);
    unsigned begin(SummedHeightItem& item);
    void ask(SummedHeightItem& item, unsigned k);
    void receive(SummedHeightItem& item, unsigned k);
    void trace_item(Signals& signals, const SummedHeightItem& item) const;
    void trace_answered(Signals& signals, const SummedHeightItem& item) const;
    void decide(Pass& pass, unsigned edge, const datapath::RectangleSize& size,
                const std::array<std::uint64_t, 3>& sums) const;

    const datapath::Registers& registers_;
};

/// An edge in the Summed Height Test: rectangles around t_i, t_j, t_ij in this order.
struct SummedHeightItem : TableItem {
    unsigned edge = 0;
    datapath::RectangleSize size;
    std::array<std::uint32_t, 3> subtracted{};  // entries of each rectangle's reads
    std::array<std::uint8_t, 3> count{};
    std::array<std::uint64_t, 3> sums{};
};

}  // namespace tessera
