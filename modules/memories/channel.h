#pragma once
#include <cstdint>

#include "modules/timing/timing.h"

namespace tessera {

/// When off-chip memory's requests are served: one channel for both directions, and for all memories that share it.
///
/// Interval:  a request takes ceil(bytes / bandwidth) cycles of the channel.
/// Latency:   it is answered `latency` cycles after its last byte.
/// Order:     in the order of the calls.
class Channel {
  public:
    explicit Channel(const OffChipTiming& timing) : timing_(timing) {}

    /// The first cycle in which the channel is free; a past one: it is.
    std::uint64_t ready() const { return free_; }

    /// Transfers `bytes`, from `cycle` on, when the channel must be free. Returns the cycle of the answer.
    std::uint64_t serve(std::uint64_t bytes, std::uint64_t cycle) {
        const std::uint64_t taken = timing_.cycles(bytes);
        free_ = cycle + taken;
        occupied_cycles_ += taken;
        return free_ + timing_.latency;
    }

    unsigned latency() const { return timing_.latency; }
    std::uint64_t occupied_cycles() const { return occupied_cycles_; }

  private:
    OffChipTiming timing_;
    std::uint64_t free_ = 0;
    std::uint64_t occupied_cycles_ = 0;
};

}  // namespace tessera
