#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/schedule/stage.h"

namespace tessera::schedule {

struct TablePlan {
    InputPlan input;
    unsigned ports = 1;  ///< of each bank
    unsigned banks = 1;
    unsigned slots = 1;  ///< cycles a port needs for an entry
    unsigned latency = 1;
    unsigned window = 0;     ///< requests whose reads overlap; 0: those that find each of their banks free
    unsigned under_way = 1;  ///< most requests at a time
};

/// A memory with one table, read by one unit.
///
/// served[n] = max(taken[n], served[n - 1], a port of each bank it reads or, with a window, the last address of request
/// n - window); answer[n] = max(answer[n - 1], its last address + latency).
class Table {
  public:
    explicit Table(const TablePlan& plan)
        : plan_(plan),
          input_(plan.input),
          ports_(std::size_t{plan.banks} * plan.ports),
          bank_slots_(plan.banks),
          window_(plan.window),
          level_(plan.under_way) {}

    /// The unit asks for `count` entries, which lie in these banks. Returns when they have come.
    Cycle request(Cycle offer, const std::uint8_t* banks, unsigned count) {
        taken_ = input_.take(offer);
        const Cycle free = std::max(taken_, served_);
        served_ = std::max(free, ready(banks, count));
        held_up_ += served_ - free;
        input_.pop(served_);
        const Cycle last = read(banks, count);
        if (plan_.window > 0)
            window_.add(last + 1);
        states_.until(served_, State::starved);
        answer_ = std::max(answer_, last + plan_.latency);
        states_.until(answer_, State::busy);
        level_.stay(offer, answer_);
        entries_ += count;
        return answer_;
    }
    /// When the last request was taken.
    Cycle taken() const { return taken_; }

    /// Cycles in which the oldest request waited for a port.
    Cycle held_up() const { return held_up_; }
    std::uint64_t entries() const { return entries_; }
    /// Port slots taken of each bank.
    const std::vector<std::uint64_t>& bank_slots() const { return bank_slots_; }
    States& states() { return states_; }
    const States& states() const { return states_; }
    Level& level() { return level_; }
    const Level& level() const { return level_; }

  private:
    Cycle& first_free(std::size_t bank) {
        const auto first = ports_.begin() + static_cast<std::ptrdiff_t>(bank * plan_.ports);
        return *std::min_element(first, first + plan_.ports);
    }
    Cycle ready(const std::uint8_t* banks, unsigned count) {
        if (plan_.window > 0)
            return window_[window_.count() - plan_.window];
        if (plan_.banks == 1)
            return first_free(0);
        Cycle cycle = 0;
        for (unsigned k = 0; k < count; ++k)
            cycle = std::max(cycle, first_free(banks[k]));
        return cycle;
    }
    /// Returns the cycle of the last entry's last address.
    Cycle read(const std::uint8_t* banks, unsigned count) {
        if (ports_.size() == 1) {
            ports_[0] = std::max(ports_[0], served_) + Cycle{count} * plan_.slots;
            bank_slots_[0] += Cycle{count} * plan_.slots;
            return ports_[0] - 1;
        }
        Cycle last = served_;
        for (unsigned k = 0; k < count; ++k) {
            const std::size_t bank = plan_.banks == 1 ? 0 : banks[k];
            Cycle& port = first_free(bank);
            port = std::max(port, served_) + plan_.slots;
            bank_slots_[bank] += plan_.slots;
            last = std::max(last, port - 1);
        }
        return last;
    }

    TablePlan plan_;
    Input input_;
    std::vector<Cycle> ports_;  // bank by bank: the cycle from which the port is free
    std::vector<std::uint64_t> bank_slots_;
    History window_;
    States states_;
    Level level_;
    Cycle taken_ = 0;
    Cycle served_ = 0;
    Cycle answer_ = 0;
    Cycle held_up_ = 0;
    std::uint64_t entries_ = 0;
};

}  // namespace tessera::schedule
