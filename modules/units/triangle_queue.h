#pragma once
#include <cstddef>
#include <cstdint>
#include <systemc>

#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"
#include "modules/units/triangle_store.h"

namespace tessera {

/// What Get Triangle sees of the Triangle Queue's level.
class TriangleQueueLevel : public virtual sc_core::sc_interface {
  public:
    /// True while fewer triangles than the watermark wait.
    virtual bool takes_host_triangles() const = 0;
    /// Asked for by a host that cannot send: notified when it may.
    virtual const sc_core::sc_event& host_may_send() = 0;
};

/// Triangle Queue (paper figure 7): waiting triangles, first in first out (the paper's) or last in first out.
///
/// In:   triangles from Tessellation. Out: to Get Triangle, a pass with the triangle.
/// Capacity: unbounded in functional mode; the high-water mark says what a design needs.
/// Timing: one triangle per interval; latency 1, interval 1 by default.
/// Waits for Tessellation; held back by Get Triangle.
class TriangleQueue : public sc_core::sc_module, public TriangleQueueLevel {
  public:
    StreamTarget<TriangleQueue, datapath::Triangle> from_tessellation{"from_tessellation"};
    StreamInitiator<TriangleQueue, datapath::TrianglePass> to_get_triangle{"to_get_triangle"};
    sc_core::sc_export<TriangleQueueLevel> level{"level"};

    /// watermark: at least 1.
    TriangleQueue(const sc_core::sc_module_name& name, TriangleOrder order, std::size_t watermark,
                  const Timing& timing);

    bool takes_host_triangles() const override { return store_.size() < watermark_; }
    const sc_core::sc_event& host_may_send() override {
        host_waits_ = true;
        return host_may_send_;
    }

    bool idle() const { return store_.empty() && !sending_; }
    std::size_t waiting() const { return store_.size(); }
    std::uint64_t taken() const { return taken_; }
    std::size_t high_water_mark() const { return high_water_mark_; }

  private:
    void b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay);
    void send_waiting();

    TriangleStore store_;
    datapath::TrianglePass pass_;
    std::size_t watermark_;
    sc_core::sc_time latency_;
    sc_core::sc_event arrival_{"arrival"};
    sc_core::sc_event host_may_send_{"host_may_send"};
    bool sending_ = false;
    bool host_waits_ = false;
    std::uint64_t taken_ = 0;
    std::size_t high_water_mark_ = 0;
};

}  // namespace tessera
