#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <systemc>
#include <type_traits>

#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"

namespace tessera {

/// One item to one or several consumers, each taking it when it can: delivered when all have.
template <class Payload>
class Fork {
  public:
    static constexpr std::size_t most = 4;

    /// only: of a Work, the parts that this output is for.
    void add(StreamOutput<Payload>& output, Parts only = all_parts) {
        if (count_ == most)
            SC_REPORT_ERROR("tessera/fork", "more than four outputs");
        to_[count_] = &output;
        only_[count_++] = only;
    }

    /// Timed mode: delivers the item to those outputs it is for that have not taken it. True: all have.
    bool deliver(Payload& payload) {
        bool all = true;
        for (std::size_t k = 0; k < count_; ++k) {
            const unsigned bit = 1u << k;
            if ((taken_ & bit) != 0 || !is_for(k, payload))
                continue;
            if (to_[k]->deliver(payload))
                taken_ |= bit;
            else
                all = false;
        }
        if (all)
            taken_ = 0;
        return all;
    }

    /// Functional mode: all outputs from the same time on, each with its parts; `delay` is the last one's on return.
    void b_transport(Payload& payload, sc_core::sc_time& delay) {
        const sc_core::sc_time start = delay;
        for (std::size_t k = 0; k < count_; ++k) {
            if (!is_for(k, payload))
                continue;
            sc_core::sc_time its_delay = start;
            if constexpr (std::is_same_v<Payload, Work>) {
                Work its{payload.pass, static_cast<Parts>(payload.parts & only_[k])};
                (*to_[k])->b_transport(its, its_delay);
            } else {
                (*to_[k])->b_transport(payload, its_delay);
            }
            delay = std::max(delay, its_delay);
        }
    }

    /// The first that has not taken what it is offered; null: none.
    const sc_core::sc_object* blocked_by() const {
        for (std::size_t k = 0; k < count_; ++k) {
            if (!to_[k]->free())
                return to_[k]->consumer();
        }
        return nullptr;
    }

  private:
    /// An item without parts goes where all parts go.
    bool is_for(std::size_t k, const Payload& payload) const {
        if constexpr (std::is_same_v<Payload, Work>)
            return only_[k] == all_parts || (only_[k] & payload.parts) != 0;
        else
            return true;
    }

    std::array<StreamOutput<Payload>*, most> to_{};
    std::array<Parts, most> only_{};
    std::size_t count_ = 0;
    unsigned taken_ = 0;  // of the item that is being delivered
};

}  // namespace tessera
