#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "modules/timing.h"

namespace tessera {

constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

/// The items in a unit's pipeline, in order: started one an interval, finished a latency later, kept until delivered.
/// Elastic: while the first cannot leave, others close up behind it, as many as there are register stages,
/// ceil(latency / interval).
template <class Item>
class ElasticPipeline {
  public:
    /// servers: pipelines side by side that take turns. further_stages: cycles an item spends outside (in a memory)
    /// that other items must be able to follow it through.
    explicit ElasticPipeline(const UnitTiming& timing, unsigned servers = 1, unsigned further_stages = 0)
        : latency_(timing.latency),
          interval_(timing.interval),
          servers_(servers),
          next_start_(servers, 0),
          capacity_(std::size_t{servers} *
                    std::max(1u, (timing.latency + further_stages + timing.interval - 1) / timing.interval)),
          ring_(capacity_) {}

    bool empty() const { return size_ == 0; }
    bool full() const { return size_ == capacity_; }
    std::size_t size() const { return size_; }
    std::size_t capacity() const { return capacity_; }

    bool may_start(std::uint64_t cycle) const { return !full() && cycle >= next_start_[server_]; }

    /// Starts an item; to be filled in. It is finished at cycle + latency, or when `finish` says.
    Item& start(std::uint64_t cycle) {
        next_start_[server_] = cycle + interval_;
        server_ = server_ + 1 == servers_ ? 0 : server_ + 1;
        Slot& slot = ring_[place(size_++)];
        slot.finished = cycle + latency_;
        return slot.item;
    }

    Item& front() { return ring_[first_].item; }
    const Item& front() const { return ring_[first_].item; }
    Item& at(std::size_t k) { return ring_[place(k)].item; }
    const Item& at(std::size_t k) const { return ring_[place(k)].item; }
    /// The item started last, even if it has left since; before the first, an empty one.
    const Item& newest() const { return ring_[(first_ + size_ + capacity_ - 1) % capacity_].item; }
    bool front_finished(std::uint64_t cycle) const { return size_ > 0 && ring_[first_].finished <= cycle; }
    void finish(std::size_t k, std::uint64_t cycle) { ring_[place(k)].finished = cycle; }
    std::uint64_t latency() const { return latency_; }

    void pop() {
        first_ = first_ + 1 == capacity_ ? 0 : first_ + 1;
        --size_;
    }

    /// The next cycle after `cycle` at which the first item is finished; `never` if that is not known or past.
    std::uint64_t next_finished(std::uint64_t cycle) const {
        return size_ > 0 && ring_[first_].finished > cycle ? ring_[first_].finished : never;
    }
    /// The next cycle after `cycle` at which an item may be started; `never` if that waits for a place.
    std::uint64_t next_start(std::uint64_t cycle) const {
        return !full() && next_start_[server_] > cycle ? next_start_[server_] : never;
    }

  private:
    struct Slot {
        Item item{};
        std::uint64_t finished = 0;
    };

    std::size_t place(std::size_t k) const {
        const std::size_t sum = first_ + k;
        return sum < capacity_ ? sum : sum - capacity_;
    }

    std::uint64_t latency_;
    std::uint64_t interval_;
    std::size_t servers_;
    std::vector<std::uint64_t> next_start_;  // one a server
    std::size_t server_ = 0;                 // whose turn it is
    std::size_t capacity_;
    std::vector<Slot> ring_;
    std::size_t first_ = 0;
    std::size_t size_ = 0;
};

}  // namespace tessera
