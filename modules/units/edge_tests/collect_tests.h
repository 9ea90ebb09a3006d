#pragma once
#include <cstdint>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/per_triangle.h"
#include "modules/units/edge_tests/collecting_unit.h"

namespace tessera {

/// Joins the results of the four tests for Pass or Tessellate (paper figure 8): an edge leaves when all have decided.
///
/// In:   each test's result. Out: TestedEdge, once.
/// Timing: one edge per cycle, no latency of its own: wires. Capacity: for each test `results_buffer` edges that wait
///       for the other tests.
/// Waits for the slowest test; held back by Pass or Tessellate.
class CollectTests : public CollectingUnit {
  public:
    StreamInput<NormalResult> from_normal_test{"from_normal_test"};
    StreamInput<TexCoordResult> from_tex_coord_test{"from_tex_coord_test"};
    StreamInput<HeightResult> from_summed_height_test{"from_summed_height_test"};
    StreamInput<ViewResult> from_view_test{"from_view_test"};
    StreamOutput<TestedEdge> to_pass_or_tessellate{"to_pass_or_tessellate"};

    CollectTests(const sc_core::sc_module_name& name, const UnitContext& context);

    StreamOutput<TestedEdge>& tested_edges(std::size_t) override { return to_pass_or_tessellate; }
    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override { return activity_.items_in(); }
    void trace_signals(Signals& signals) const override;

  private:
    /// Functional mode: the results so far for the edge under way, and the time of the last one.
    struct Decided {
        TestedEdge edge;
        unsigned tests = 0;
        sc_core::sc_time latest;
    };

    template <class Result>
    void add_input(const UnitContext& context, StreamInput<Result>& input);
    template <class Result>
    void b_transport(Result& result, sc_core::sc_time& delay);
    template <class Result>
    void take(StreamInput<Result>& input);
    void step() override;

    const datapath::Registers& registers_;
    TestedEdge leaving_;
    bool leaves_ = false;
    unsigned empty_inputs_ = 0;
    PerTriangle<Decided> decided_{1};
};

}  // namespace tessera
