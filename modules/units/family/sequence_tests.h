#pragma once
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/timing/ring.h"
#include "modules/units/edge_tests/sequencing_unit.h"

namespace tessera {

/// Sequence Tests in the family design. Several lanes of cheap tests share one or more Normal Tests and the Summed
/// Height Test. An edge leaves as soon as it is decided: Pass or Tessellate finds its family by its tag. In order of
/// arrival every edge would wait for the slowest test.
///
/// In:   from each lane the operands of the two table tests and the results of the cheap tests; the results of the
///       table tests.
/// Out:  operands to the Normal Tests and to the Summed Height Test; TestedEdge, once, on any lane: an edge with the
///       tests that were evaluated.
/// Arithmetic: none.
/// Timing: one edge per cycle and lane in and out, no latency of its own.
/// Capacity: `edges_in_sequence` edges (32), from their cheap tests' results until they leave; `results_buffer` at each
///       input.
/// Waits only for its inputs; held back by the Normal Tests, the Summed Height Test and Pass or Tessellate.
class FamilySequenceTests : public SequencingUnit {
  public:
    // One per lane.
    sc_core::sc_vector<StreamInput<NormalOperands>> normal_operands;
    sc_core::sc_vector<StreamInput<HeightOperands>> height_operands;
    sc_core::sc_vector<StreamInput<TexCoordResult>> from_tex_coord_test;
    sc_core::sc_vector<StreamInput<ViewResult>> from_view_test;
    sc_core::sc_vector<StreamOutput<TestedEdge>> to_pass_or_tessellate;
    // One per Normal Test.
    sc_core::sc_vector<StreamOutput<NormalOperands>> to_normal_test;
    sc_core::sc_vector<StreamInput<NormalResult>> from_normal_test;

    FamilySequenceTests(const sc_core::sc_module_name& name, const UnitContext& context);

    StreamOutput<TestedEdge>& tested_edges(std::size_t lane) override { return to_pass_or_tessellate[lane]; }
    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override { return activity_.items_in() / lanes_.size(); }
    void trace_signals(Signals& signals) const override;

  private:
    struct Lane {
        unsigned empty_inputs = 0;  // of four; without one an edge can be taken
        std::uint64_t next_in = 0, next_out = 0;
        TestedEdge leaving;
    };
    /// The edges of one Normal Test.
    struct Normal {
        Ring<Edge> in_test;
        NormalOperands offered;
    };

    StreamOutput<NormalOperands>& normal_test() override { return to_normal_test[0]; }
    void step() override;
    bool take_edge(std::size_t lane, std::uint64_t cycle);
    Ring<Edge>& waiting_for(Next next);
    void decided(const Edge& edge, Next next);
    bool take_results();
    bool send_to_normal_test();
    bool send_to_summed_height_test();
    bool leave(std::uint64_t cycle);

    std::vector<Lane> lanes_;
    std::size_t places_;
    std::size_t taken_ = 0;  // places in use
    Ring<Edge> for_normal_, for_height_;
    std::vector<Normal> normals_;
    Ring<Edge> in_height_;
    HeightOperands height_offered_;
    Ring<TestedEdge> leaving_;
    std::size_t normal_turn_ = 0;
    std::size_t last_lane_ = 0;  // from which an edge left
};

}  // namespace tessera
