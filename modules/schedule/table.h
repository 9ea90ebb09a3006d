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

/// The banks of a table, and their ports.
///
/// A request is served when a port of each bank it reads is free or, with a window, when request n - window has sent its last
/// address.
class Ports {
  public:
    explicit Ports(const TablePlan& plan)
        : plan_(plan), free_(std::size_t{plan.banks} * plan.ports), bank_slots_(plan.banks), window_(plan.window) {}

    /// The first cycle in which the ports allow a request for `count` entries, which lie in these banks.
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
    /// It is served in `cycle`. Returns when its last entry comes.
    Cycle serve(const std::uint8_t* banks, unsigned count, Cycle cycle) {
        const Cycle last = read(banks, count, cycle);
        if (plan_.window > 0)
            window_.add(last + 1);
        entries_ += count;
        return last + plan_.latency;
    }

    std::uint64_t entries() const { return entries_; }
    /// Port slots taken of each bank.
    const std::vector<std::uint64_t>& bank_slots() const { return bank_slots_; }

  private:
    Cycle& first_free(std::size_t bank) {
        const auto first = free_.begin() + static_cast<std::ptrdiff_t>(bank * plan_.ports);
        return *std::min_element(first, first + plan_.ports);
    }
    /// Returns the cycle of the last entry's last address.
    Cycle read(const std::uint8_t* banks, unsigned count, Cycle cycle) {
        if (free_.size() == 1) {
            free_[0] = std::max(free_[0], cycle) + Cycle{count} * plan_.slots;
            bank_slots_[0] += Cycle{count} * plan_.slots;
            return free_[0] - 1;
        }
        Cycle last = cycle;
        for (unsigned k = 0; k < count; ++k) {
            const std::size_t bank = plan_.banks == 1 ? 0 : banks[k];
            Cycle& port = first_free(bank);
            port = std::max(port, cycle) + plan_.slots;
            bank_slots_[bank] += plan_.slots;
            last = std::max(last, port - 1);
        }
        return last;
    }

    TablePlan plan_;
    std::vector<Cycle> free_;  // bank by bank: the cycle from which the port is free
    std::vector<std::uint64_t> bank_slots_;
    History window_;
    std::uint64_t entries_ = 0;
};

/// A memory with one table, read by one unit.
///
/// served[n] = max(taken[n], served[n - 1], its ports); answer[n] = max(answer[n - 1], its last address + latency).
class Table {
  public:
    explicit Table(const TablePlan& plan) : input_(plan.input), ports_(plan), level_(plan.under_way) {}

    /// The unit asks for `count` entries, which lie in these banks. Returns when they have come.
    Cycle request(Cycle offer, const std::uint8_t* banks, unsigned count) {
        taken_ = input_.take(offer);
        const Cycle free = std::max(taken_, served_);
        served_ = std::max(free, ports_.ready(banks, count));
        held_up_ += served_ - free;
        input_.pop(served_);
        states_.until(served_, State::starved);
        answer_ = std::max(answer_, ports_.serve(banks, count, served_));
        states_.until(answer_, State::busy);
        level_.stay(offer, answer_);
        return answer_;
    }
    /// When the last request was taken.
    Cycle taken() const { return taken_; }

    /// Cycles in which the oldest request waited for a port.
    Cycle held_up() const { return held_up_; }
    const Ports& ports() const { return ports_; }
    States& states() { return states_; }
    const States& states() const { return states_; }
    Level& level() { return level_; }
    const Level& level() const { return level_; }

  private:
    Input input_;
    Ports ports_;
    States states_;
    Level level_;
    Cycle taken_ = 0;
    Cycle served_ = 0;
    Cycle answer_ = 0;
    Cycle held_up_ = 0;
};

}  // namespace tessera::schedule
