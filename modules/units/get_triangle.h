#pragma once
#include <cstdint>
#include <systemc>

#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"
#include "modules/units/triangle_queue.h"

namespace tessera {

/// Get Triangle (paper figure 7): takes a triangle from the Triangle Queue or from the host and sends it down both
/// branches. Knows which of its vertices and normals are already in screen space and sends only the new ones on:
///
///   base triangle          three vertices to displace and transform, then three edges
///   re-tessellated         normals that have no N's yet, then three edges
///   finished, without N's  its normals only: no edge is tested again
///
/// In:   a pass with its triangle. Out: the same with new_vertices, new_normals, tested set.
/// Timing: one triangle per interval; latency 1, interval 1 by default. Capacity: one triangle.
/// Waits for the Triangle Queue or the host; takes a host triangle only while the queue is below its watermark.
/// Held back by Calculate New P and Tessellation Tests.
class GetTriangle : public sc_core::sc_module {
  public:
    StreamTarget<GetTriangle, datapath::TrianglePass> from_host{"from_host"};
    StreamTarget<GetTriangle, datapath::TrianglePass> from_triangle_queue{"from_triangle_queue"};
    StreamInitiator<GetTriangle, datapath::TrianglePass> to_calculate_new_p{"to_calculate_new_p"};
    StreamInitiator<GetTriangle, datapath::TrianglePass> to_tessellation_tests{"to_tessellation_tests"};
    sc_core::sc_port<TriangleQueueLevel> queue_level{"queue_level"};

    GetTriangle(const sc_core::sc_module_name& name, const Timing& timing);

    std::uint64_t host_triangles() const { return host_triangles_; }
    std::uint64_t queue_triangles() const { return queue_triangles_; }

    /// Sets what has to be sent on: the unit's whole decision.
    static void prepare(datapath::TrianglePass& pass);

  private:
    void b_transport_from_host(datapath::TrianglePass& pass, sc_core::sc_time& delay);
    void b_transport_from_triangle_queue(datapath::TrianglePass& pass, sc_core::sc_time& delay);
    void send(datapath::TrianglePass& pass, sc_core::sc_time& delay);

    sc_core::sc_time latency_;
    std::uint64_t host_triangles_ = 0;
    std::uint64_t queue_triangles_ = 0;
};

}  // namespace tessera
