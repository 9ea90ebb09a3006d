#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/datapath/triangle_pass.h"
#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/per_triangle.h"
#include "modules/timing/elastic_pipeline.h"
#include "modules/units/deciding_unit.h"
#include "modules/units/joining_unit.h"

namespace tessera {

/// Pass or Tessellate (paper figures 7 and 8, 3.1.5): joins Transform and Tessellation Tests, decides per edge, and
/// culls finished triangles that face away.
///
/// In:   each triangle from Get Triangle, and its parts from both branches; the last part completes it.
/// Out:  to Tessellation, a triangle with split != 0, or one that is finished but lacks N's of a vertex (it makes one
///       more pass for its normals: N' of a base vertex comes from Tessellation Tests, so that N's follows on the next
///       pass, as in the paper for inserted vertices); to Lighting, a finished triangle.
/// Arithmetic: logic; for culling two products of screen bits + 1 and a compare.
/// Check: both branches' t_ij must agree, else SC_ERROR.
/// Timing: one triangle per interval, a latency after its last part. In order of arrival: a complete triangle waits for
///       older ones.
/// Capacity: `buffer` incomplete triangles. A triangle waits at the input from Get Triangle until its first part
///       arrives from Transform and opens a place for it; that input has room for all triangles that can be ahead of
///       their parts (triangles_ahead_of_parts). Edges from Tessellation Tests that arrive earlier wait at their own
///       input, which holds as many edges as there are places. (Decision: if the first part of either branch opened a
///       place, triangles behind a pass for normals, which has no tests, could take all places: a deadlock.)
/// Waits for both branches; held back by Tessellation and Lighting.
class PassOrTessellate : public DecidingUnit, public JoiningUnit {
  public:
    sc_core::sc_vector<StreamInput<TestedEdge>> from_tessellation_tests;  ///< one per Tessellation Tests unit
    StreamOutput<DecidedTriangle> to_tessellation{"to_tessellation"};

    PassOrTessellate(const sc_core::sc_module_name& name, const UnitContext& context);

    bool joined() const override { return incomplete_.empty(); }
    std::size_t most_incomplete() const override { return most_incomplete_; }
    /// Most triangles that waited for their first part at the end of a cycle; at least one if any triangle arrived.
    std::size_t most_ahead_of_parts() const override {
        return std::max({most_ahead_of_parts_, ahead_of_parts_, std::size_t{from_get_triangle.taken() > 0}});
    }

    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override { return activity_.items_out() * timing_.interval; }
    void trace_signals(Signals& signals) const override;

  private:
    /// A decided triangle on its way out, for the unit it goes to.
    struct Decided {
        Way way = Way::dropped;
        DecidedTriangle to_tessellation;
        TriangleToLight to_lighting;
    };
    /// What waveforms show of a decided triangle.
    struct Shown {
        Origin origin;
        std::array<std::uint8_t, 3> tests{};
        std::uint8_t split = 0;
        Way way = Way::dropped;
    };

    /// An incomplete triangle: the parts that have yet to arrive from Transform and from Tessellation Tests; in
    /// functional mode, the time at which the last part arrived.
    struct Incomplete {
        DecidedTriangle triangle;
        Parts geometry_left = 0;
        Parts tests_left = 0;
        sc_core::sc_time latest;

        bool complete() const { return geometry_left == 0 && tests_left == 0; }
    };

    void b_transport_from_get_triangle(TakenTriangle& taken, sc_core::sc_time& delay);
    void b_transport_from_transform(ScreenPoint& part, sc_core::sc_time& delay);
    void b_transport_from_tests(TestedEdge& edge, sc_core::sc_time& delay);
    Incomplete& place_of(const PartTag& tag);
    void finish_if_complete(Incomplete& place, const PartTag& tag, sc_core::sc_time& delay);
    void step() override;
    void take_parts(std::uint64_t cycle);
    Incomplete* open_place(const PartTag& tag, std::uint64_t cycle);
    void open(const TakenTriangle& taken);
    static void take(Incomplete& place, const ScreenPoint& part);
    static void take(Incomplete& place, const TestedEdge& edge);
    bool deliver(Decided& next);
    bool first_is_complete() const { return !incomplete_.empty() && incomplete_.oldest().complete(); }
    const sc_core::sc_object* late_branch() const;
    void end_of_elaboration() override;

    /// Completes the triangle and returns its destination.
    Way decide(DecidedTriangle& whole);
    Way join(datapath::TrianglePass& pass);

    PerTriangle<Incomplete> incomplete_;
    std::size_t most_incomplete_ = 0;
    std::size_t most_ahead_of_parts_ = 0;
    std::size_t ahead_of_parts_ = 0;  // at the end of the last step
    std::uint64_t stepped_ = 0;       // cycle of the last step
    ElasticPipeline<Decided> pipeline_;
    Shown last_;
    const sc_core::sc_object* transform_ = nullptr;
    std::vector<const sc_core::sc_object*> tests_;  // one per Tessellation Tests unit
};

}  // namespace tessera
