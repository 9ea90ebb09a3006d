#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Tex Coord Test (paper figure 8, 2.5, 3.1.2): is the map's resolution reached? With it, on the same wires, the
/// Generation Test (algorithm section 4), which like it bounds the recursion and needs only the two ends.
///
/// In:   t_i, t_j, generations; edges[k].texture. Out: tex_coord_bit and generation_bit of edges[k].tests.
/// Arithmetic: compares of bit slices; a maximum, an increment and a compare of generation_bits.
/// Timing: one edge per interval; latency 1, interval 1 by default. Waits for Calculate New U.
class TexCoordTest : public sc_core::sc_module {
  public:
    StreamTarget<TexCoordTest, datapath::TrianglePass> input{"input"};

    TexCoordTest(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                 const Timing& timing);

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
};

}  // namespace tessera
