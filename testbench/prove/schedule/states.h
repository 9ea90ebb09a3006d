#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/timing/state.h"
#include "testbench/prove/schedule/history.h"
#include "testbench/prove/schedule/units.h"

namespace tessera::schedule {

/// Counts a unit's cycles by state and by the unit responsible. Stretches of cycles are added in order of time.
class States {
  public:
    struct Share {
        State state = State::starved;
        Unit by = nobody;
        Cycle cycles = 0;
    };
    static constexpr std::size_t most_shares = 12;

    /// Adds a stretch in this state, from the end of the last stretch up to, but not including, `cycle`. Does nothing
    /// if the last stretch ends there or later.
    void until(Cycle cycle, State state, Unit by = nobody) {
        if (cycle <= since_)
            return;
        cycles_[static_cast<std::size_t>(state)] += cycle - since_;
        if (by != nobody)
            share(state, by).cycles += cycle - since_;
        since_ = cycle;
    }

    Cycle cycles_in(State state) const { return cycles_[static_cast<std::size_t>(state)]; }
    /// In the order of their first stretches. The first entry with by == nobody ends the list.
    const std::array<Share, most_shares>& shares() const { return shares_; }

  private:
    Share& share(State state, Unit by) {
        const auto is_it = [&](const Share& share) {
            return share.by == nobody || (share.by == by && share.state == state);
        };
        if (shares_[recent_].by != by || shares_[recent_].state != state)
            recent_ =
                static_cast<std::size_t>(std::find_if(shares_.begin(), shares_.end() - 1, is_it) - shares_.begin());
        shares_[recent_].state = state;
        shares_[recent_].by = by;
        return shares_[recent_];
    }

    std::array<Cycle, states> cycles_{};
    std::array<Share, most_shares> shares_{};
    std::size_t recent_ = 0;
    Cycle since_ = 0;
};

/// Receives the cycle in which each item enters a unit (came) and leaves it.
class ItemObserver {
  public:
    virtual void item(Cycle cycle, bool came) = 0;
    virtual ~ItemObserver() = default;
};

/// The number of items in a unit. Items leave it in order of arrival.
class Level {
  public:
    /// most: the largest number of items at a time.
    explicit Level(std::size_t most) : out_(most + 1) {}

    /// The next item entered in cycle `in` and left in cycle `out`.
    void stay(Cycle in, Cycle out) {
        while (left_ < items() && out_[left_] <= in)
            ++left_;
        out_.add(out);
        most_ = std::max(most_, items() - left_ - (out == in ? 1 : 0));
        item_cycles_ += out - in;
        if (observer_ != nullptr) {
            observer_->item(in, true);
            observer_->item(out, false);
        }
    }
    void observe(ItemObserver* observer) { observer_ = observer; }

    std::uint64_t items() const { return out_.count(); }
    /// Most items at the end of a cycle; at least one if any item entered.
    std::uint64_t most() const { return std::max(most_, std::min(items(), std::uint64_t{1})); }
    /// The sum of the cycles that each item spent in the unit.
    std::uint64_t item_cycles() const { return item_cycles_; }

  private:
    History out_;
    std::uint64_t left_ = 0;
    std::uint64_t most_ = 0;
    std::uint64_t item_cycles_ = 0;
    ItemObserver* observer_ = nullptr;
};

}  // namespace tessera::schedule
