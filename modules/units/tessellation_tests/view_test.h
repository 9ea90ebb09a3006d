#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"
#include "modules/timing.h"
#include "modules/unit/work_stage.h"

namespace tessera {

/// View Test (paper figure 8, 2.4, 3.1.1): is the edge long enough on the screen to be worth splitting?
///
/// In:   edges, with P's of both ends. Out: view_bit of edges[k].tests. An edge with one end on or behind the near plane
///       counts as long, with both as invisible.
/// Arithmetic: two subtractions, absolute values, add, compare.
/// Timing: one edge per interval; latency 1, interval 1 by default.
/// Waits for Calculate New U, and for a base triangle's edge until Transform has sent the screen positions of its
/// vertices, which it takes at any time. Held back by the collection of the tests.
class ViewTest : public WorkStage<ViewTest> {
  public:
    StreamInput<Work> input{"input"};
    StreamInput<Work> from_transform{"from_transform"};
    StreamOutput<Work> output{"output"};

    /// number: of the Tessellation Tests unit it is part of.
    ViewTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
             const Timing& timing, unsigned number);

    void show(Signals& signals) const override;

  private:
    friend class WorkStage<ViewTest>;
    void b_transport(Work& work, sc_core::sc_time& delay);
    void b_transport_from_transform(Work& work, sc_core::sc_time& delay);
    void process(const Work& work);
    void trace_item(Signals& signals, const Work& work) const;
    bool may_begin(const Work& work);
    const sc_core::sc_object* lacks() const { return transform_; }
    void step() override;
    void end_of_elaboration() override;

    const datapath::Registers& registers_;
    unsigned number_;
    const sc_core::sc_object* transform_ = nullptr;
    const Pass* on_screen_ = nullptr;   // functional mode: base triangle whose screen positions have come
    sc_core::sc_time on_screen_delay_;  // and when
};

}  // namespace tessera
