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

/// What serves a table's requests, in order: its banks and their ports.
///
/// A request is served when a port of each bank it reads is free or, with a window, when request n - window has sent its last
/// address; answer[n] = max(answer[n - 1], its last address + latency).
class Ports {
  public:
    /// most: requests at a time.
    Ports(const TablePlan& plan, std::size_t most)
        : plan_(plan),
          free_(std::size_t{plan.banks} * plan.ports),
          bank_slots_(plan.banks),
          window_(plan.window),
          level_(most) {}

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
    /// It was offered and taken in these cycles and is served in `cycle`. Returns when its last entry comes.
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
    /// When the last request was served.
    Cycle served() const { return served_; }

    std::uint64_t entries() const { return entries_; }
    /// Cycles in which the oldest request waited for a port.
    Cycle held_up() const { return held_up_; }
    /// Port slots taken of each bank.
    const std::vector<std::uint64_t>& bank_slots() const { return bank_slots_; }
    States& states() { return states_; }
    Level& level() { return level_; }

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
    States states_;
    Level level_;
    Cycle served_ = 0;
    Cycle answer_ = 0;
    Cycle held_up_ = 0;
};

/// A memory with one table, read by one unit: served[n] = max(taken[n], served[n - 1], its ports).
class Table {
  public:
    explicit Table(const TablePlan& plan) : input_(plan.input), ports_(plan, plan.under_way) {}

    /// The unit asks for `count` entries, which lie in these banks. Returns when they have come.
    Cycle request(Cycle offer, const std::uint8_t* banks, unsigned count) {
        taken_ = input_.take(offer);
        const Cycle served = std::max({taken_, ports_.served(), ports_.ready(banks, count)});
        input_.pop(served);
        return ports_.serve(offer, taken_, banks, count, served);
    }
    /// When the last request was taken.
    Cycle taken() const { return taken_; }
    Ports& ports() { return ports_; }

  private:
    Input input_;
    Ports ports_;
    Cycle taken_ = 0;
};

}  // namespace tessera::schedule
