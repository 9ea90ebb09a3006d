#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/unit/per_triangle.h"
#include "modules/unit/stage.h"

namespace tessera {

/// View Test (paper figure 8, 2.4, 3.1.1): is the edge long enough on the screen to be worth splitting?
///
/// In:   edges, with P's of both ends. Out: view_bit of edges[k].tests. An edge with one end on or behind the near plane
///       counts as long, with both as invisible.
/// Arithmetic: two subtractions, absolute values, add, compare.
/// Timing: one edge per interval; latency 1, interval 1 by default.
/// State: for each base triangle under way between Transform and Pass or Tessellate its tag and which of its corners are on
///        the screen: as many places as Pass or Tessellate has, and two for what waits at its input.
/// Waits for Calculate New U, and for a base triangle's edge until Transform has sent the screen positions of its
/// vertices, which it takes at any time. Held back by the collection of the tests.
class ViewTest final : public Stage<Work> {
  public:
    StreamInput<Work> input{"input"};
    StreamInput<Work> from_transform{"from_transform"};
    StreamOutput<Work> output{"output"};

    /// takes: the vertices and edges of a triangle that come to the unit (parts_for_tests).
    ViewTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
             const Timing& timing, Parts takes);

    void show(Signals& signals) const override;

  private:
    /// Which of a base triangle's corners are on the screen; functional mode: since when.
    struct Corners {
        Parts on_screen = 0;
        sc_core::sc_time since;
    };

    void take_corner(Work& corner, sc_core::sc_time& when);
    void step() override;
    bool may_start(const Work& edge) const override;
    sc_core::sc_time may_start_after(const Work& edge) const override;
    const sc_core::sc_object* lacks() const override { return transform_; }
    Work process(const Work& edge, const Entries& entries) override;
    void trace_processed(Signals& signals, const Work& edge, const Work& result) const override;
    void end_of_elaboration() override;

    const datapath::Registers& registers_;
    Parts last_edge_;  // that comes of a triangle
    PerTriangle<Corners> corners_;
    const sc_core::sc_object* transform_ = nullptr;
};

}  // namespace tessera
