#pragma once
#include <cstdint>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/timing/ring.h"
#include "modules/units/edge_tests/sequencing_unit.h"

namespace tessera {

/// Sequence Tests: replaces Collect Tests in a design whose tests are evaluated cheapest first. It sends an edge to a
/// test only if the decision still depends on that test (sequencing_unit.h).
///
/// (Decision: in the paper's design 69 to 86 % of the table reads serve edges that another test has already kept whole
/// or split. Each test depends on the edge alone, so that their order changes no decision.)
///
/// In:   from Calculate New U the operands of the two table tests; vertices of a base triangle, which go on to the
///       Normal Test; each test's result.
/// Out:  operands to the Normal and the Summed Height Test; TestedEdge, once, with the tests that were evaluated, in
///       order of arrival, so that later units need not search for tags.
/// Arithmetic: none.
/// Timing: one edge per cycle in each direction, no latency of its own. Capacity: `edges_in_sequence` edges (32; with
///       16 the default job is 5 % slower, with 64 no faster), from their cheap tests' results until they leave;
///       `results_buffer` at each input.
/// Waits for the tests of its oldest edge. Held back by the Normal Test, the Summed Height Test, Pass or Tessellate.
class SequenceTests : public SequencingUnit {
  public:
    StreamInput<NormalOperands> normal_operands{"normal_operands"};
    StreamInput<HeightOperands> height_operands{"height_operands"};
    StreamInput<TexCoordResult> from_tex_coord_test{"from_tex_coord_test"};
    StreamInput<ViewResult> from_view_test{"from_view_test"};
    StreamOutput<NormalOperands> to_normal_test{"to_normal_test"};
    StreamInput<NormalResult> from_normal_test{"from_normal_test"};
    StreamOutput<TestedEdge> to_pass_or_tessellate{"to_pass_or_tessellate"};

    SequenceTests(const sc_core::sc_module_name& name, const UnitContext& context);

    StreamOutput<TestedEdge>& tested_edges(std::size_t) override { return to_pass_or_tessellate; }
    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override { return activity_.items_in(); }
    void trace_signals(Signals& signals) const override;

  private:
    StreamOutput<NormalOperands>& normal_test() override { return to_normal_test; }
    void step() override;
    bool take_edge(std::uint64_t cycle);
    bool may_take(std::uint64_t cycle);
    bool take_vertex(std::uint64_t cycle);
    bool send_on();
    template <class Result>
    bool take_result(StreamInput<Result>& input, Next expected);
    bool leave(std::uint64_t cycle);
    Edge* first(Next next);
    Edge* in_test(const PartTag& tag, Next expected);

    Ring<Edge> edges_;
    NormalOperands vertex_;  // on offer to the Normal Test
    bool vertex_waits_ = false;
    Edge* to_normal_ = nullptr;  // the edge on offer; null: none
    Edge* to_height_ = nullptr;
    TestedEdge left_;  // the edge that left last
    std::uint64_t next_take_ = 0, next_leave_ = 0;
};

}  // namespace tessera
