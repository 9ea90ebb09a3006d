#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/stage/unit.h"
#include "modules/units/part_sender.h"

namespace tessera {

/// Get Triangle (paper figure 7): takes a triangle from the Triangle Queue or from the host and sends it down both
/// branches, part by part. Vertices and normals that are already in screen space are not sent again, nor are final
/// edges (Formats::final_edges):
///
///   base triangle          three vertices to displace and transform (and to bump), then three edges
///   re-tessellated         normals that have no N's yet, then the edges that are not final
///   finished, without N's  its normals only: no edge is tested again
///
/// In the family design (Formats::families) it sends nothing to the tests. To Calculate New P it sends the vertices of
/// a base triangle, or the midpoints of the split edges of a triangle from the queue, with the tests' N and N'.
///
/// In:   triangles; the queue's level. Out: to Calculate New P all parts, to Tessellation Tests vertices and edges;
///       with three Tessellation Tests units edge k and its two vertices to unit k. To Pass or Tessellate the triangle
///       itself, for the values that its parts do not carry. (Decision: a stream of their own, since with the parts
///       they would pass nine times through branches that do not use them.)
/// Timing: one part per interval on each output, the first a latency after the triangle was accepted.
/// Capacity: one triangle; the next is accepted when all parts of the last have been accepted.
/// Waits for the Triangle Queue or the host; accepts a host triangle only while the queue is below its watermark
/// and, in timed mode, has nothing to send, so that the queue does not grow while it has work. Held back by Calculate
/// New P, Tessellation Tests and Pass or Tessellate.
class GetTriangle : public Unit {
  public:
    StreamInput<datapath::Triangle> from_host{"from_host"};
    StreamInput<datapath::Triangle> from_triangle_queue{"from_triangle_queue"};
    StreamInput<QueueLevel> queue_level{"queue_level"};
    StreamOutput<GeometryOperands> to_calculate_new_p{"to_calculate_new_p"};
    sc_core::sc_vector<StreamOutput<TestOperands>>
        to_tessellation_tests;            ///< one per Tessellation Tests unit; none in the family design
    StreamOutput<TakenTriangle> to_join;  ///< to Pass or Tessellate; in the family design to Tessellation

    GetTriangle(const sc_core::sc_module_name& name, const UnitContext& context);

    /// A source has begun a frame (Machine::begin_frame). A triangle before is an SC_ERROR.
    void begin_frame() { frame_begun_ = true; }

    std::uint64_t host_triangles() const { return host_triangles_; }
    std::uint64_t queue_triangles() const { return queue_triangles_; }
    /// Timed mode: vertices, normals and edges sent to Calculate New P.
    std::uint64_t parts_sent() const { return to_calculate_new_p.sent(); }

    std::string describe_contents() const override;
    std::uint64_t occupied_cycles() const override {
        return one_at_a_time_cycles(timing_, activity_.items_in(), parts_sent());
    }
    void trace_signals(Signals& signals) const override;

  private:
    void b_transport_from_host(datapath::Triangle& triangle, sc_core::sc_time& delay);
    void b_transport_from_triangle_queue(datapath::Triangle& triangle, sc_core::sc_time& delay);
    void b_transport_level(QueueLevel& level, sc_core::sc_time& delay);
    void take_from_host();
    void send_whole(const datapath::Triangle& triangle, sc_core::sc_time& delay);
    TakenTriangle taken(const datapath::Triangle& triangle);
    void step() override;
    bool begin(std::uint64_t cycle);
    bool send_parts(std::uint64_t cycle);
    const sc_core::sc_object* blocked_by() const;

    UnitTiming timing_;
    sc_core::sc_time latency_;
    Tag tag_mask_;
    Work work_;
    std::uint32_t passes_ = 0;
    TakenTriangle taken_;  // timed mode: the triangle whose parts are being sent
    bool sending_ = false;
    PartSender<GeometryOperands> geometry_;
    std::array<PartSender<TestOperands>, most_tests_units> tests_;
    std::size_t tests_units_;
    bool below_watermark_ = true;  // the Triangle Queue
    bool frame_begun_ = false;
    std::uint64_t host_triangles_ = 0;
    std::uint64_t queue_triangles_ = 0;

    sc_core::sc_event host_may_send_{"host_may_send"};  // functional mode
    bool host_waits_ = false;
};

}  // namespace tessera
