#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/datapath/family.h"
#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/per_triangle.h"
#include "modules/timing/elastic_pipeline.h"
#include "modules/units/deciding_unit.h"

namespace tessera {

/// Pass or Tessellate in the family design: collects the tests' results for the edges of a family, and decides all its
/// children.
///
/// In:   each family from Tessellation, and its tested edges, in any order; the last one completes it.
/// Out:  to Lighting the children without split edges; to the Triangle Queue the children that split, with N, T and N'
///       of their split edges (435 bits by default; calculating them again would take 51 multipliers) and their own
///       `split_by` and `parent`. Both in the order of the families. A base triangle is the only child of its family.
/// Arithmetic: logic; for culling two products of screen bits + 1 and a compare.
/// Timing: one family per interval is decided, when its last edge has arrived; then one child per interval leaves on
///       each output, the first a latency later. A culled child takes an interval of the output to Lighting.
/// Capacity: `buffer` families, from arrival until the last child has left. A family is accepted only if a place is
///       free, and only then are its edges sent: an edge without a place would hold back those that older families
///       wait for, a deadlock.
/// Waits for Tessellation Tests; held back by Lighting and the Triangle Queue.
class FamilyPassOrTessellate : public DecidingUnit {
  public:
    StreamInput<Family> from_tessellation{"from_tessellation"};
    sc_core::sc_vector<StreamInput<TestedEdge>> from_tessellation_tests;  ///< one per lane
    StreamOutput<datapath::Triangle> to_triangle_queue{"to_triangle_queue"};

    FamilyPassOrTessellate(const sc_core::sc_module_name& name, const UnitContext& context);

    bool joined() const override { return places_.empty(); }
    std::size_t most_incomplete() const override { return most_incomplete_; }

    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override {
        return std::max({families_decided_, lit_children_, queued_children_}) * timing_.interval;
    }
    void trace_signals(Signals& signals) const override;

  private:
    struct Child {
        datapath::Triangle triangle;
        Way way = Way::dropped;
    };
    /// A family, its edges' results, and then its children; in functional mode, the arrival time of the last edge.
    struct Place {
        Family family;
        datapath::ChildIndices indices;
        datapath::FamilyEdges edges;
        Parts left = 0;  // edges that have not arrived
        std::array<datapath::EdgeTests, 9> found{};
        std::array<Child, 4> children{};
        sc_core::sc_time latest;
    };
    /// The child that leaves next on an output.
    struct Next {
        std::size_t place = 0;
        int child = 0;
    };
    /// A child without split edges on its way to Lighting, or culled.
    struct Leaving {
        TriangleToLight triangle;
        bool culled = false;
    };
    struct Shown {
        Origin origin;
        unsigned children = 0, split = 0;
    };

    void b_transport_from_tessellation(Family& family, sc_core::sc_time& delay);
    void b_transport_from_tests(TestedEdge& edge, sc_core::sc_time& delay);
    void finish_if_complete(Place& place, sc_core::sc_time& delay);
    void step() override;
    bool take_inputs(std::uint64_t cycle);
    void open(const Family& family);
    static void take(Place& place, const TestedEdge& edge);
    void decide(Place& place);
    void decide_child(Place& place, std::size_t c, unsigned& told);
    Child* next(Next& from, bool whole);
    bool start_children(std::uint64_t cycle);
    bool close_places(std::uint64_t cycle);
    void end_of_elaboration() override;

    PerTriangle<Place> places_;
    bool front_has_place_ = false;  // the family at the input has a place; it stays there while no other is free
    std::size_t decided_ = 0;       // families in places_ that are decided: the first ones
    std::uint64_t next_decision_ = 0;
    Next next_lit_, next_queued_;
    ElasticPipeline<Leaving> lit_;
    ElasticPipeline<datapath::Triangle> queued_;
    std::size_t most_incomplete_ = 0;
    std::uint64_t families_decided_ = 0;
    std::uint64_t lit_children_ = 0;  // or culled
    std::uint64_t queued_children_ = 0;
    Shown last_;
    std::vector<const sc_core::sc_object*> tests_;
};

}  // namespace tessera
