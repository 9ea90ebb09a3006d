#include "modules/units/triangle_queue.h"

#include <algorithm>

namespace tessera {

namespace {
// The work runs ahead of the kernel's time by so many triangles at most, so that a stop is heard.
constexpr unsigned triangles_between_waits = 1024;
}  // namespace

TriangleQueue::TriangleQueue(const sc_core::sc_module_name& name, TriangleOrder order, std::size_t watermark,
                             const Timing& timing)
    : sc_module(name),
      store_(order),
      watermark_(std::max<std::size_t>(watermark, 1)),
      latency_(timing.cycle * timing.triangle_queue.latency) {
    from_tessellation.register_b_transport(this, &TriangleQueue::b_transport);
    level.bind(*this);
    SC_HAS_PROCESS(TriangleQueue);
    SC_THREAD(send_waiting);
}

void TriangleQueue::b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    store_.push(triangle);
    ++taken_;
    high_water_mark_ = std::max(high_water_mark_, store_.size());
    delay += latency_;
    if (!sending_)
        arrival_.notify(sc_core::SC_ZERO_TIME);
}

void TriangleQueue::send_waiting() {
    for (;;) {
        if (store_.empty())
            wait(arrival_);
        sending_ = true;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        for (unsigned sent = 1; !store_.empty(); ++sent) {
            if (sent % triangles_between_waits == 0) {
                wait(delay);
                delay = sc_core::SC_ZERO_TIME;
            }
            pass_.triangle = store_.pop();
            to_get_triangle->b_transport(pass_, delay);
            if (host_waits_ && takes_host_triangles()) {
                host_waits_ = false;
                host_may_send_.notify();
                wait(delay);
                delay = sc_core::SC_ZERO_TIME;
            }
        }
        sending_ = false;
        host_waits_ = false;
        wait(delay);
        host_may_send_.notify();
    }
}

}  // namespace tessera
