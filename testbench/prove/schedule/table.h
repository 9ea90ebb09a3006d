#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "testbench/prove/schedule/stage.h"

namespace tessera::schedule {

struct TablePlan {
    InputPlan input;
    unsigned ports = 1;  ///< of each bank
    unsigned banks = 1;
    unsigned slots = 1;  ///< cycles a port needs for an entry
    unsigned latency = 1;
    unsigned window = 0;     ///< most requests whose reads overlap; 0: a request waits until each of its banks is free
    unsigned under_way = 1;  ///< most requests at a time
};

/// The banks and ports of a table, which serve its requests in order.
///
/// A request is served when a port of each bank it reads is free or, with a window, when request n - window has sent
/// its last address; answer[n] = max(answer[n - 1], its last address + latency).
class Ports {
  public:
    explicit Ports(const TablePlan& plan)
        : plan_(plan),
          free_(std::size_t{plan.banks} * plan.ports),
          bank_slots_(plan.banks),
          window_(plan.window),
          level_(plan.under_way) {}

    /// The first cycle in which the ports allow a request for `count` entries in these banks.
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
    /// Serves in `cycle` a request that was offered and accepted in these cycles. Returns the arrival of its last
    /// entry.
    Cycle serve(Cycle offer, Cycle taken, const std::uint8_t* banks, unsigned count, Cycle cycle) {
        held_up_ += cycle - std::max(taken, served_);
        served_ = cycle;
        states_.until(cycle, State::starved);
        const Cycle last = read(banks, count, cycle);
        if (plan_.window > 0)
            window_.add(last + 1);
        entries_ += count;
        answer_ = std::max(answer_, last + plan_.latency);
        states_.until(answer_, State::busy);
        level_.stay(offer, answer_);
        return answer_;
    }
    /// The cycle in which the last request was served.
    Cycle served() const { return served_; }

    std::uint64_t entries() const { return entries_; }
    /// Cycles in which the oldest request waited for a port.
    Cycle held_up() const { return held_up_; }
    unsigned ports_of_a_bank() const { return plan_.ports; }
    /// Port slots taken, by bank.
    const std::vector<std::uint64_t>& bank_slots() const { return bank_slots_; }
    States& states() { return states_; }
    Level& level() { return level_; }

  private:
    Cycle& first_free(std::size_t bank) {
        const auto first = free_.begin() + static_cast<std::ptrdiff_t>(bank * plan_.ports);
        return *std::min_element(first, first + plan_.ports);
    }
    /// Returns the last cycle in which the entries' addresses occupy a port.
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
    std::vector<Cycle> free_;  // bank by bank: the cycle from which each port is free
    std::vector<std::uint64_t> bank_slots_;
    History window_;
    std::uint64_t entries_ = 0;
    States states_;
    Level level_;
    Cycle served_ = 0;
    Cycle answer_ = 0;
    Cycle held_up_ = 0;
};

/// A memory with one table, read by one unit: served[n] = max(taken[n], served[n - 1], its ports free).
class Table {
  public:
    explicit Table(const TablePlan& plan) : input_(plan.input), ports_(plan) {}

    /// Requests `count` entries in these banks. Returns the cycle in which the last one arrives.
    Cycle request(Cycle offer, const std::uint8_t* banks, unsigned count) {
        taken_ = input_.take(offer);
        const Cycle served = std::max({taken_, ports_.served(), ports_.ready(banks, count)});
        input_.pop(served);
        return ports_.serve(offer, taken_, banks, count, served);
    }
    /// The cycle in which the last request was accepted.
    Cycle taken() const { return taken_; }
    Ports& ports() { return ports_; }

  private:
    Input input_;
    Ports ports_;
    Cycle taken_ = 0;
};

}  // namespace tessera::schedule
