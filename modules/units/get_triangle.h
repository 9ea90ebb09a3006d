#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/datapath/vertex.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"
#include "modules/timing.h"
#include "modules/unit/pass_pool.h"
#include "modules/unit/unit.h"
#include "modules/units/triangle_queue_level.h"

namespace tessera {

/// Get Triangle (paper figure 7): takes a triangle from the Triangle Queue or from the host and sends it down both
/// branches, part by part. Knows which of its vertices and normals are already in screen space and sends only the new
/// ones on:
///
///   base triangle          three vertices to displace and transform (and to bump), then three edges
///   re-tessellated         normals that have no N's yet, then three edges
///   finished, without N's  its normals only: no edge is tested again
///
/// In:   triangles. Out: to Calculate New P all parts, to Tessellation Tests vertices and edges; with three Tessellation
///       Tests units edge k and its two vertices to unit k.
/// Timing: one part per interval (1) on each output, the first a latency (1) after the triangle was taken. Capacity: one
///       triangle; the next is taken when all parts of the last have been.
/// Waits for the Triangle Queue or the host; takes a host triangle only while the queue is below its watermark and has
/// nothing to send. Held back by Calculate New P and Tessellation Tests.
class GetTriangle : public Unit {
  public:
    StreamInput<datapath::Triangle> from_host{"from_host"};
    StreamInput<datapath::Triangle> from_triangle_queue{"from_triangle_queue"};
    StreamOutput<Work> to_calculate_new_p{"to_calculate_new_p"};
    sc_core::sc_vector<StreamOutput<Work>> to_tessellation_tests;  ///< one per Tessellation Tests unit
    sc_core::sc_port<TriangleQueueLevel> queue_level{"queue_level"};

    GetTriangle(const sc_core::sc_module_name& name, Clock& clock, const Timing& timing, unsigned tests_units,
                PassPool& passes);

    std::uint64_t host_triangles() const { return host_triangles_; }
    std::uint64_t queue_triangles() const { return queue_triangles_; }
    /// Vertices, normals and edges sent to Calculate New P.
    std::uint64_t parts_sent() const { return parts_sent_; }

    std::string holds() const override;
    std::uint64_t occupied_cycles() const override {
        return one_at_a_time_cycles(timing_, activity_.items_in(), parts_sent_);
    }
    void show(Signals& signals) const override;
    Begun begun() const override { return Begun::of(activity_.items_in(), {pass_, 0}); }

    /// Sets what has to be sent on: the unit's whole decision.
    static void prepare(datapath::TrianglePass& pass);

  private:
    /// One output's share of the pass: what is left to send, and what is on offer.
    struct Branch {
        StreamOutput<Work>* output = nullptr;
        Parts takes = 0;  // of a triangle
        Parts left = 0;
        Work offered;
        std::uint64_t next = 0;
    };

    void b_transport_from_host(datapath::Triangle& triangle, sc_core::sc_time& delay);
    void b_transport_from_triangle_queue(datapath::Triangle& triangle, sc_core::sc_time& delay);
    void send_whole(const datapath::Triangle& triangle, sc_core::sc_time& delay);
    void step() override;
    bool begin(std::uint64_t cycle);
    bool send_parts(Branch& branch, std::uint64_t cycle);

    UnitTiming timing_;
    PassPool& passes_;
    Pass* pass_ = nullptr;  // timed mode: what is being sent
    std::array<Branch, 4> branches_;
    unsigned branch_count_ = 0;
    std::uint64_t host_triangles_ = 0;
    std::uint64_t queue_triangles_ = 0;
    std::uint64_t parts_sent_ = 0;
};

}  // namespace tessera
