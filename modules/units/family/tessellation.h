#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/per_triangle.h"
#include "modules/units/joining_unit.h"
#include "modules/units/part_sender.h"
#include "modules/units/tessellation.h"

namespace tessera {

/// Tessellation in the family design, upstream of the tests. It joins a triangle that will be split with its midpoints,
/// chooses the diagonal, and sends each new edge of the children to the tests once. A base triangle is joined with its
/// vertices; its three edges are new.
///
/// (Decision: the triangle design needs a pass to determine that nothing splits, displaces midpoints of edges that are
/// then not split, tests inner edges from both sides, and transforms normals to view space in a pass of their own. Here
/// edges tested = 3 x finished triangles + edges left uncut, and midpoints displaced = edges split, which every run
/// checks.)
///
/// In:   each triangle from Get Triangle, and its parts from Transform; the last part completes it.
/// Out:  to Pass or Tessellate the triangle and its inserted vertices; once these are accepted, to Tessellation Tests
///       the edges, every n-th to each of n lanes.
/// Arithmetic: wiring; with the `shorter` diagonal two Manhattan lengths and a compare. New vertices' generations
///       saturate (counted), which can only happen with the Generation Test off.
/// Timing: the family and the first edge of each lane a latency after the last part arrived, then one per interval.
/// Capacity: one triangle being joined and one whose edges are being sent; triangles wait at the input from Get
///       Triangle until their first part arrives (triangles_ahead_of_parts).
/// Waits for Transform; held back by Tessellation Tests and Pass or Tessellate.
class FamilyTessellation : public TessellatingUnit, public JoiningUnit {
  public:
    sc_core::sc_vector<StreamOutput<TestOperands>> to_tessellation_tests;  ///< one per lane
    StreamOutput<Family> to_pass_or_tessellate{"to_pass_or_tessellate"};

    FamilyTessellation(const sc_core::sc_module_name& name, const UnitContext& context);

    /// Edges sent to the tests.
    std::uint64_t parts_sent() const { return parts_sent_; }
    std::size_t most_ahead_of_parts() const override { return most_ahead_of_parts_; }

    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override {
        return one_at_a_time_cycles(timing_, activity_.items_in(), most_parts_);
    }
    void trace_signals(Signals& signals) const override;

  private:
    /// A triangle whose parts are arriving; in functional mode, the time at which the last one arrived.
    struct Joined {
        TakenTriangle taken;
        Parts left = 0;
        bool untested = false;  // a base triangle
        std::array<datapath::NewVertex, 3> made{};
        sc_core::sc_time latest;
    };
    /// The family for Pass or Tessellate, and the parts for the tests.
    struct Sent {
        Family family;
        datapath::FamilyEdges edges;
        Parts parts = 0;
    };

    void b_transport_from_get_triangle(TakenTriangle& taken, sc_core::sc_time& delay);
    void b_transport_from_transform(ScreenPoint& part, sc_core::sc_time& delay);
    static void open(Joined& joined, const TakenTriangle& taken);
    static void take(Joined& joined, const ScreenPoint& part);
    void tessellate(const Joined& joined, Sent& sent);
    static TestOperands operands(const Sent& sent, Parts part);
    void step() override;
    bool join();
    bool send_family();
    bool send_parts(std::uint64_t cycle);

    sc_core::sc_time latency_;
    PerTriangle<Joined> joined_{1};
    Sent sent_;  // timed mode: being sent
    bool sending_ = false;
    bool family_sent_ = false;  // Pass or Tessellate has accepted the family
    std::uint64_t start_ = 0;   // cycle from which sent_ may be sent
    std::vector<PartSender<TestOperands>> lanes_;
    std::uint64_t parts_sent_ = 0;
    std::size_t most_ahead_of_parts_ = 0;
    std::uint64_t most_parts_ = 0;  // sum over triangles of the parts on the output that sends most
    const sc_core::sc_object* transform_ = nullptr;

    void end_of_elaboration() override;
};

}  // namespace tessera
