#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <utility>

#include "modules/timing/state.h"

namespace tessera {

/// Observes the items that enter and leave a unit.
class ActivityObserver {
  public:
    virtual void item(std::uint64_t cycle, bool came) = 0;
    virtual ~ActivityObserver() = default;
};

/// Counts a unit's cycles by state, and the items in it. An item stays in a unit from its start to its delivery,
/// without its time in the input buffer, so that occupancy = throughput times latency can be checked by hand. Where
/// storing items is the purpose all of their time counts: in a memory from request to response, in the Triangle Queue
/// from arrival to departure, off chip included.
class Activity {
  public:
    // Called in every step; without the attributes gcc does not inline them there.
    /// Sets the state at the end of `cycle`. It lasts until another is set. The last call in a cycle counts.
    [[gnu::always_inline]] void set(std::uint64_t cycle, State state, const sc_core::sc_object* by = nullptr) {
        if (state != state_ || by != by_ || until_ != UINT64_MAX)
            change(cycle, state, by);
    }
    /// The same for a state of which the end is known: from cycle `until` on it is `then`.
    [[gnu::always_inline]] void set_until(std::uint64_t until, State then, std::uint64_t cycle, State state,
                                          const sc_core::sc_object* by = nullptr) {
        if (state != state_ || by != by_ || cycle > until_)
            change(cycle, state, by);
        until_ = until;
        then_ = then;
    }

    [[gnu::always_inline]] void item_in(std::uint64_t cycle) {
        end_of_cycle_before(cycle);
        item_cycles_ -= cycle;
        ++items_in_;
        ++level_;
        if (observer_ != nullptr)
            observer_->item(cycle, true);
    }
    [[gnu::always_inline]] void item_out(std::uint64_t cycle) {
        end_of_cycle_before(cycle);
        item_cycles_ += cycle;
        ++items_out_;
        --level_;
        if (observer_ != nullptr)
            observer_->item(cycle, false);
    }

    /// An item of which both cycles are known when it comes. level: the items in the unit at the end of cycle `in`.
    void item_through(std::uint64_t in, std::uint64_t out, std::uint64_t level) {
        item_cycles_ += out - in;
        ++items_in_;
        ++items_out_;
        high_water_mark_ = std::max(high_water_mark_, level);
        if (observer_ != nullptr) {
            observer_->item(in, true);
            observer_->item(out, false);
        }
    }

    /// Accounts for the cycles up to `cycle`, the run's end.
    void finish(std::uint64_t cycle) {
        close(cycle);
        end_of_cycle_before(cycle);
    }

    State state() const { return state_; }
    const sc_core::sc_object* by() const { return by_; }
    std::uint64_t cycles_in(State state) const { return cycles_[static_cast<std::size_t>(state)]; }

    /// Cycles in which the unit was blocked by, or waited for, one particular module, as given to `set`.
    struct Share {
        State state = State::starved;
        const sc_core::sc_object* by = nullptr;
        std::uint64_t cycles = 0;
    };
    static constexpr std::size_t most_shares = 12;
    const std::array<Share, most_shares>& shares() const { return shares_; }

    std::uint64_t items_in() const { return items_in_; }
    std::uint64_t items_out() const { return items_out_; }
    std::uint64_t level() const { return level_; }
    /// Most items at the end of a cycle; at least one if any item entered. Independent of the order of calls in a
    /// cycle.
    std::uint64_t high_water_mark() const {
        return std::max({high_water_mark_, level_, std::min(items_in_, std::uint64_t{1})});
    }
    /// Sum over all cycles of the items in the unit: mean occupancy times cycles, or the sum of all residence times.
    std::uint64_t item_cycles() const { return item_cycles_ + level_ * level_since_; }

    void observe(ActivityObserver* observer) { observer_ = observer; }

  private:
    // Rare: kept out of the callers' code.
    [[gnu::noinline]] void change(std::uint64_t cycle, State state, const sc_core::sc_object* by) {
        close(cycle);
        state_ = state;
        by_ = by;
        until_ = UINT64_MAX;
    }
    void close(std::uint64_t cycle) {
        if (until_ < cycle) {
            add_cycles(std::exchange(until_, UINT64_MAX));
            state_ = then_;
            by_ = nullptr;
        }
        add_cycles(cycle);
    }
    void add_cycles(std::uint64_t cycle) {
        if (cycle <= since_)
            return;
        const std::uint64_t length = cycle - since_;
        cycles_[static_cast<std::size_t>(state_)] += length;
        if (by_ != nullptr)
            present_share().cycles += length;
        since_ = cycle;
    }
    Share& present_share() {
        if (shares_[recent_].by == by_ && shares_[recent_].state == state_)
            return shares_[recent_];
        for (recent_ = 0; recent_ < most_shares; ++recent_) {
            Share& share = shares_[recent_];
            if (share.by == nullptr)
                share = {state_, by_, 0};
            if (share.by == by_ && share.state == state_)
                return share;
        }
        SC_REPORT_ERROR("tessera/activity", "a unit has more neighbours than can be distinguished");
        return shares_[recent_ = 0];
    }
    /// level_ was the level at the end of each cycle from level_since_ to `cycle` - 1.
    void end_of_cycle_before(std::uint64_t cycle) {
        if (cycle > level_since_)
            high_water_mark_ = std::max(high_water_mark_, level_);
        level_since_ = cycle;
    }

    State state_ = State::starved;
    const sc_core::sc_object* by_ = nullptr;
    std::uint64_t until_ = UINT64_MAX;  // the state is then_ from this cycle on
    State then_ = State::starved;
    std::uint64_t since_ = 0;
    std::array<std::uint64_t, states> cycles_{};
    std::array<Share, most_shares> shares_{};
    std::size_t recent_ = 0;  // the share that was added to last
    std::uint64_t items_in_ = 0;
    std::uint64_t items_out_ = 0;
    std::uint64_t level_ = 0;
    std::uint64_t high_water_mark_ = 0;
    std::uint64_t item_cycles_ = 0;  // sum of the cycles in which items left, minus of those they entered in, mod 2^64
    std::uint64_t level_since_ = 0;
    ActivityObserver* observer_ = nullptr;
};

}  // namespace tessera
