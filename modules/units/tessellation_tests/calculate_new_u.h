#pragma once
#include <systemc>

#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Calculate New U (paper figure 8, 3.1.2): the texture coordinate of the edge's midpoint.
///
/// In:   t_i, t_j. Out: edges[k].texture = (t_i + t_j) >> 1.
/// Arithmetic: add, shift by 1.
/// Timing: one edge per interval; latency 1, interval 1 by default. Waits for nothing, held back by nothing within
/// Tessellation Tests.
class CalculateNewU : public sc_core::sc_module {
  public:
    StreamTarget<CalculateNewU, datapath::TrianglePass> input{"input"};

    CalculateNewU(const sc_core::sc_module_name& name, const Timing& timing);

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);

    sc_core::sc_time latency_;
};

}  // namespace tessera
