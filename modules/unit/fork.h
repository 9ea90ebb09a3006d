#pragma once
#include <array>
#include <cstddef>
#include <systemc>

#include "modules/stream/stream_output.h"

namespace tessera {

/// One item to one or several consumers, each taking it when it can: delivered when all have.
template <class Payload>
class Fork {
  public:
    static constexpr std::size_t most = 4;

    void add(StreamOutput<Payload>& output) {
        if (count_ == most)
            SC_REPORT_ERROR("tessera/fork", "more than four outputs");
        to_[count_++] = &output;
    }

    /// Offers the item to those outputs of `mask` that have not been offered it. True: all have taken it.
    bool deliver(Payload& payload, unsigned mask = ~0u) {
        if (count_ == 1) {
            if (offered_ != 0 ? !to_[0]->free() : !to_[0]->send(payload)) {
                offered_ = 1;
                return false;
            }
            offered_ = 0;
            return true;
        }
        bool all = true;
        for (std::size_t k = 0; k < count_; ++k) {
            const unsigned bit = 1u << k;
            if ((mask & bit) == 0)
                continue;
            if ((offered_ & bit) == 0) {
                offered_ |= bit;
                all = to_[k]->send(payload) && all;
            } else {
                all = all && to_[k]->free();
            }
        }
        if (all)
            offered_ = 0;
        return all;
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
    std::array<StreamOutput<Payload>*, most> to_{};
    std::size_t count_ = 0;
    unsigned offered_ = 0;
};

}  // namespace tessera
