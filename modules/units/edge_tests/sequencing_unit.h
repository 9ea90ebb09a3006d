#pragma once
#include <cstdint>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/per_triangle.h"
#include "modules/units/edge_tests/collecting_unit.h"

namespace tessera {

/// Common base of Sequence Tests in the triangle design (sequence_tests.h) and in the family design
/// (family/sequence_tests.h): determines which tests an edge needs, and runs them in functional mode.
///
///   Tex Coord Test (with Generation), View Test   every edge; they read no table
///   Normal Test                                   edges that none of these keeps whole; in the triangle design also
///                                                 a base triangle's edges, which carry the N' of its vertices
///   Summed Height Test, or Curvature or Mipmap    edges that may split, and that neither Normal nor Highlight Test
///                                                 splits
///
/// A Rank Test, which reads one entry, is evaluated before the Normal Test, except for the edges of a base triangle:
/// the Normal Test keeps the corners' N' of one triangle at a time. Edges without a midpoint on the lattice skip it.
/// The Normal Test then receives the edges that the Rank Test splits, for N' of their midpoints, and the others only if
/// it is switched on.
class SequencingUnit : public CollectingUnit {
  public:
    StreamOutput<HeightOperands> to_summed_height_test{"to_summed_height_test"};
    StreamInput<HeightResult> from_summed_height_test{"from_summed_height_test"};

  protected:
    enum class Next : std::uint8_t { normal_test, normal_result, summed_height_test, summed_height_result, leave };
    /// An edge between its cheap tests and its decision.
    struct Edge {
        TestedEdge tested;
        NormalOperands normal;
        HeightOperands height;
        Next next = Next::leave;
    };

    SequencingUnit(const sc_core::sc_module_name& name, const UnitContext& context);

    template <class Item>
    void add_input(const UnitContext& context, StreamInput<Item>& input);
    Next after_cheap_tests(const TestedEdge& edge, const NormalOperands& normal, const HeightOperands& height) const;
    Next after_normal_test(const Edge& edge) const;
    Next after_height_test(const TestedEdge& edge) const;

    /// Functional mode: the output that is used.
    virtual StreamOutput<NormalOperands>& normal_test() = 0;

    const datapath::Registers& registers_;
    const bool height_first_;  // a Rank Test

  private:
    /// Functional mode: an edge whose operands and cheap results have not all arrived.
    struct Arriving {
        Edge edge;
        datapath::EdgeInView ends;  // of the View Test's result
        unsigned come = 0;
        sc_core::sc_time latest;
    };

    template <class Item>
    void b_transport(Item& item, sc_core::sc_time& delay);
    void run_tests(Edge& edge, sc_core::sc_time& delay);
    bool has_rank(const HeightOperands& edge) const;
    Next without_rank() const;

    PerTriangle<Arriving> arriving_{1};
    PerTriangle<TestedEdge*> in_test_{1};  // functional mode: the edge that a test is evaluating
};

}  // namespace tessera
