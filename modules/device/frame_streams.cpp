#include "modules/device/frame_streams.h"

namespace tessera {

FrameStreams::FrameStreams(const sc_core::sc_module_name& name, CycleScheduler& clock, const Design& design,
                           std::size_t triangles_ahead, std::size_t finished_triangles)
    : sc_module(name),
      clock_(clock),
      timed_(design.transport == Transport::non_blocking),
      most_to_send_(triangles_ahead),
      most_finished_(finished_triangles) {
    clock.attach(*this);
    to_get_triangle.clocked_by(clock, *this);
    from_lighting.register_b_transport<&FrameStreams::b_transport>(*this);
    from_lighting.clocked_by(clock, *this, 1, design.timing.stalls);
}

void FrameStreams::send(const datapath::Triangle& triangle, sc_core::sc_time& delay) {
    if (!timed_) {
        datapath::Triangle sent = triangle;
        to_get_triangle.transport(sent, delay);
        return;
    }
    while (to_send_.size() >= most_to_send_ && !clock_.halted())
        wait(room_to_send_ | clock_.quiet());
    if (discarding_)
        return;
    to_send_.push_back(triangle);
    clock_.wake(*this);
}

FrameStreams::Finished FrameStreams::take() {
    Finished first = finished_.front();
    finished_.pop_front();
    room_for_finished_.notify(sc_core::SC_ZERO_TIME);
    if (timed_)
        clock_.wake(*this);
    return first;
}

void FrameStreams::discard(bool discarding) {
    discarding_ = discarding;
    if (!discarding)
        return;
    to_send_.clear();
    finished_.clear();
    room_to_send_.notify(sc_core::SC_ZERO_TIME);
    room_for_finished_.notify(sc_core::SC_ZERO_TIME);
    if (timed_)
        clock_.wake(*this);
}

bool FrameStreams::idle() const {
    return to_send_.empty() && finished_.empty() && to_get_triangle.free() && from_lighting.empty() &&
           !from_lighting.holds_back();
}

/// Functional mode.
void FrameStreams::b_transport(LitTriangle& triangle, sc_core::sc_time& delay) {
    if (!room_for_finished()) {
        wait(delay);
        delay = sc_core::SC_ZERO_TIME;
    }
    while (!room_for_finished())
        wait(room_for_finished_);
    if (discarding_)
        return;
    finished_.push_back({triangle, sc_core::sc_time_stamp() + delay});
    come_.notify(sc_core::SC_ZERO_TIME);
}

void FrameStreams::step() {
    while (!to_send_.empty() && to_get_triangle.free()) {
        offered_ = to_send_.front();
        to_send_.pop_front();
        room_to_send_.notify(sc_core::SC_ZERO_TIME);
        to_get_triangle.send(offered_);
    }
    while (!from_lighting.empty() && room_for_finished()) {
        if (!discarding_) {
            finished_.push_back({from_lighting.front(), sc_core::sc_time_stamp()});
            come_.notify(sc_core::SC_ZERO_TIME);
        }
        from_lighting.pop();
    }
}

}  // namespace tessera
