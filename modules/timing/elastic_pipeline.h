#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "modules/timing/design.h"
#include "modules/timing/ring.h"

namespace tessera {

constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

/// The items in a unit's pipeline, in order: started one per interval, finished a latency later, kept until delivered.
/// Elastic: while the first item cannot leave, others close up behind it, up to the number of register stages
/// (register_stages). (Decision: a rigid pipeline would need a stall signal to every register.)
template <class Item>
class ElasticPipeline {
  public:
    /// servers: parallel pipelines, used round-robin. further_stages: cycles that an item spends outside (in a memory)
    /// while others follow it.
    explicit ElasticPipeline(const UnitTiming& timing, unsigned servers = 1, unsigned further_stages = 0)
        : latency_(timing.latency),
          interval_(timing.interval),
          servers_(servers),
          next_starts_(servers == 1 ? 0 : servers, 0),
          stages_(register_stages(timing, servers, further_stages)) {}

    bool empty() const { return stages_.empty(); }
    bool full() const { return stages_.full(); }
    std::size_t size() const { return stages_.size(); }
    std::size_t capacity() const { return stages_.capacity(); }

    bool may_start(std::uint64_t cycle) const { return !full() && cycle >= next_start_; }

    /// Starts an item, to be filled in. It is finished at cycle + latency, or when set by `finish`.
    Item& start(std::uint64_t cycle) {
        next_start_ = cycle + interval_;
        if (servers_ != 1) {
            next_starts_[server_] = next_start_;
            server_ = server_ + 1 == servers_ ? 0 : server_ + 1;
            next_start_ = next_starts_[server_];
        }
        Stage& stage = stages_.push();
        stage.finished = cycle + latency_;
        return stage.item;
    }

    Item& front() { return stages_.front().item; }
    const Item& front() const { return stages_.front().item; }
    Item& at(std::size_t k) { return stages_.at(k).item; }
    const Item& at(std::size_t k) const { return stages_.at(k).item; }
    /// The item started last, even if it has already left; before the first, an empty one.
    const Item& newest() const { return stages_.back().item; }
    bool front_finished(std::uint64_t cycle) const { return !empty() && stages_.front().finished <= cycle; }
    void finish(std::size_t k, std::uint64_t cycle) { stages_.at(k).finished = cycle; }
    std::uint64_t latency() const { return latency_; }

    void pop() { stages_.pop(); }

    /// The next cycle after `cycle` at which the first item is finished; `never` if unknown or past.
    std::uint64_t next_finished(std::uint64_t cycle) const {
        return !empty() && stages_.front().finished > cycle ? stages_.front().finished : never;
    }
    /// The next cycle after `cycle`, no earlier than `earliest`, at which an item may start; `never` if that depends on
    /// a free place.
    std::uint64_t next_start(std::uint64_t cycle, std::uint64_t earliest = 0) const {
        const std::uint64_t next = std::max(next_start_, earliest);
        return !full() && next > cycle ? next : never;
    }

  private:
    struct Stage {
        Item item{};
        std::uint64_t finished = 0;
    };

    std::uint64_t latency_;
    std::uint64_t interval_;
    std::size_t servers_;
    std::vector<std::uint64_t> next_starts_;  // by server, if there are several
    std::uint64_t next_start_ = 0;            // of the next server
    std::size_t server_ = 0;                  // the next server
    Ring<Stage> stages_;
};

}  // namespace tessera
