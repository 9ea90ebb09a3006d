#pragma once
#include <algorithm>
#include <cstdint>
#include <systemc>

#include "modules/sockets/parts.h"
#include "modules/sockets/stream_output.h"

namespace tessera {

/// One output of a unit that sends a triangle in parts: its parts that are still to be sent, and the part on offer.
/// `make(item, part)` makes the item of a part.
template <class Item>
struct PartSender {
    StreamOutput<Item>* output = nullptr;
    Parts takes = 0;  ///< of a triangle
    Parts left = 0;
    Item offered;
    std::uint64_t next = 0;  ///< cycle from which the next part may be sent

    void begin(Parts parts, std::uint64_t cycle) {
        left = static_cast<Parts>(parts & takes);
        next = std::max(next, cycle);
    }

    /// Timed mode: sends a part if it is time. Returns true if nothing is left to send and nothing is on offer. Calls
    /// `wake_at(cycle)` if a part is to be sent later.
    template <class Make, class WakeAt>
    bool send(std::uint64_t cycle, std::uint64_t interval, Make&& make, WakeAt&& wake_at) {
        if (!output->free())
            return false;
        if (left == 0)
            return true;
        if (next > cycle) {
            wake_at(next);
            return false;
        }
        const auto part = static_cast<Parts>(left & -left);
        left = static_cast<Parts>(left & ~part);
        make(offered, part);
        next = cycle + interval;
        const bool was_taken = output->send(offered);
        if (left != 0)
            wake_at(next);
        return was_taken && left == 0;
    }

    /// Functional mode: sends its parts one after another, each at `start`; `delay` is then that of the last to finish.
    template <class Make>
    void transport(Parts parts, const sc_core::sc_time& start, sc_core::sc_time& delay, Make&& make) {
        for (unsigned rest = parts & takes; rest != 0; rest &= rest - 1) {
            Item item;
            make(item, static_cast<Parts>(rest & -rest));
            sc_core::sc_time its_delay = start;
            output->transport(item, its_delay);
            delay = std::max(delay, its_delay);
        }
    }
};

}  // namespace tessera
