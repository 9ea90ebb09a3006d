#pragma once
#include <array>
#include <optional>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/stage/per_triangle.h"
#include "modules/stage/stage.h"

namespace tessera {

/// View Test (paper figure 8, 2.4, 3.1.1): is the edge long enough on the screen to be worth splitting?
///
/// In:   ViewOperands; for a base triangle also its three ScreenCorners. Out: ViewResult. An edge with one end on or
///       behind the near plane counts as long; with both ends there it counts as invisible.
/// Arithmetic: two subtractions, absolute values, add, compare; for a view-dependent Rank Test two adds, of the ends'
///       distances and depths.
/// Timing: one edge per interval.
/// State: for each base triangle between Transform and Pass or Tessellate its tag and the corners that have arrived:
///        as many places as Pass or Tessellate has, and two for the triangles that wait at its input.
/// Waits for Calculate New U, and for an edge of a base triangle also for the screen positions of its vertices from
/// Transform, which are accepted at any time. Held back by the collector of the tests.
class ViewTest : public Stage<ViewOperands, ViewResult> {
  public:
    StreamInput<ViewOperands> input{"input"};
    std::optional<StreamInput<ScreenCorner>> from_transform;  ///< not in the family design, whose edges carry P's
    StreamOutput<ViewResult> output{"output"};

    ViewTest(const sc_core::sc_module_name& name, const UnitContext& context);

    void trace_signals(Signals& signals) const override;

  protected:
    /// The corners of a base triangle that have arrived, and their positions; in functional mode, the time of the last.
    struct Corners {
        Parts come = 0;
        std::array<datapath::ScreenPosition, 3> screen;
        sc_core::sc_time since;
    };
    struct Ends {
        datapath::ScreenPosition i, j;
    };

    void take_corner(ScreenCorner& corner, sc_core::sc_time& when);
    void step() override;
    bool may_start(const ViewOperands& edge) const override;
    sc_core::sc_time may_start_after(const ViewOperands& edge) const override;
    const sc_core::sc_object* awaited_unit() const override { return transform_; }
    ViewResult process(const ViewOperands& edge, const Entries& entries) override;
    void trace_processed(Signals& signals, const ViewOperands& edge, const ViewResult& result) const override;
    void end_of_elaboration() override;

    const datapath::Registers& registers_;
    Parts last_edge_;  // the last edge of a triangle that this unit receives
    PerTriangle<Corners> corners_;
    Ends ends_;  // of the edge decided last
    const sc_core::sc_object* transform_ = nullptr;
};

}  // namespace tessera
