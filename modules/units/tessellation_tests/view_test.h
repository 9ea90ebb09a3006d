#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// View Test (paper figure 8, 2.4, 3.1.1): is the edge long enough on the screen to be worth splitting?
///
/// In:   P's of both ends. Out: view_bit of edges[k].tests. An edge with one end on or behind the near plane counts as
///       long, with both as invisible.
/// Arithmetic: two subtractions, absolute values, add, compare.
/// Timing: one edge per interval; latency 1, interval 1 by default.
/// Waits, for a base triangle only, until Transform has sent the screen positions of its own vertices.
class ViewTest : public sc_core::sc_module {
  public:
    StreamTarget<ViewTest, datapath::TrianglePass> input{"input"};
    StreamTarget<ViewTest, datapath::TrianglePass> from_transform{"from_transform"};

    ViewTest(const sc_core::sc_module_name& name, const datapath::Registers& registers, const Timing& timing);

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);
    void b_transport_from_transform(datapath::TrianglePass& pass, sc_core::sc_time& delay);

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
    const datapath::TrianglePass* on_screen_ = nullptr;  // base triangle whose screen positions have come
    sc_core::sc_time on_screen_delay_;                   // and when
};

}  // namespace tessera
