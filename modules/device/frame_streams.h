#pragma once
#include <cstddef>
#include <deque>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/stream_input.h"
#include "modules/sockets/stream_output.h"
#include "modules/timing/design.h"

namespace tessera {

/// The machine's two external streams for the device's threads: two queues, the same in both modes.
///
/// In:       base triangles from a thread, lit triangles from Lighting. Out: base triangles to Get Triangle, lit
///           triangles to a thread.
/// Capacity: a number of base triangles ahead of Get Triangle (timed mode), and of lit triangles. While no lit triangle
///           is taken, a full queue holds Lighting back, and with it the machine.
class FrameStreams : public sc_core::sc_module, public CycleProcess {
  public:
    StreamOutput<datapath::Triangle> to_get_triangle{"to_get_triangle"};
    StreamInput<LitTriangle> from_lighting{"from_lighting"};

    struct Finished {
        LitTriangle triangle;
        sc_core::sc_time time;  ///< from which it is available; functional mode: may be later than now
    };

    FrameStreams(const sc_core::sc_module_name& name, CycleScheduler& clock, const Design& design,
                 std::size_t triangles_ahead, std::size_t finished_triangles);

    /// Call from a thread. Functional mode: on return the triangle is in the machine, and `delay` has increased. Timed
    /// mode: waits for room, unless the clock has halted; `delay` is not used.
    void send(const datapath::Triangle& triangle, sc_core::sc_time& delay);

    bool has_finished() const { return !finished_.empty(); }
    /// Removes and returns the first lit triangle.
    Finished take();
    /// Notified when a lit triangle has arrived.
    const sc_core::sc_event& come() const { return come_; }

    /// While set, nothing is sent, and lit triangles are dropped. Setting it drops the triangles in the queues.
    void discard(bool discarding);

    /// True if nothing is in either queue, or on its way between them and the machine.
    bool idle() const;

  private:
    void b_transport(LitTriangle& triangle, sc_core::sc_time& delay);
    void step() override;
    bool room_for_finished() const { return discarding_ || finished_.size() < most_finished_; }

    CycleScheduler& clock_;
    bool timed_;
    std::size_t most_to_send_;
    std::size_t most_finished_;
    std::deque<datapath::Triangle> to_send_;
    datapath::Triangle offered_;
    std::deque<Finished> finished_;
    bool discarding_ = false;
    sc_core::sc_event room_to_send_{"room_to_send"};
    sc_core::sc_event room_for_finished_{"room_for_finished"};
    sc_core::sc_event come_{"come"};
};

}  // namespace tessera
