#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/memory/memory_port.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Summed Height Test (paper figure 8, 2.3, 3.1.3): does the average height around the midpoint differ from that
/// around the ends?
///
/// In:   t_i, t_j; edges[k].texture. Out: summed_height_bit of edges[k].tests.
/// Memory: three rectangles an edge on the Summed Height Table, four reads each; up to nine where a rectangle wraps
///         around a repeated map.
/// Arithmetic: subtract, shift, add, compare; sums modulo 2^n. With the area threshold two multiplications.
/// Timing: latency 3 plus the table reads: with one port a rectangle takes four cycles, an edge 12, a triangle 36.
/// Waits for Calculate New U and the Summed Height Table.
class SummedHeightTest : public sc_core::sc_module {
  public:
    StreamTarget<SummedHeightTest, datapath::TrianglePass> input{"input"};
    MemoryPort summed_height_table;

    SummedHeightTest(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                     const Timing& timing, bool use_direct_memory);

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);
    std::uint64_t sum_around(const datapath::TexCoord& t, const datapath::RectangleSize& size,
                             MemoryPort::Burst& table) const;

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
};

}  // namespace tessera
