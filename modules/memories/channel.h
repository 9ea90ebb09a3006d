#pragma once
#include <cstdint>

#include "modules/timing/timing.h"

namespace tessera {

/// The timing of off-chip memory: one channel for both directions, shared by all off-chip memories.
///
/// Interval:  a request occupies the channel for ceil(bytes / bandwidth) cycles.
/// Latency:   it is answered `latency` cycles after its last byte.
/// Order:     order of the calls.
class Channel {
  public:
    explicit Channel(const OffChipTiming& timing) : timing_(timing) {}

    /// The first cycle in which the channel is free; a past cycle means that it is free now.
    std::uint64_t ready() const { return free_; }

    /// Transfers `bytes`, starting in `cycle`, in which the channel must be free. Returns the cycle of the answer.
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
