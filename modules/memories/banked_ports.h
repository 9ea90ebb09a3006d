#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/timing/timing.h"

namespace tessera {

/// When a table's entries are read: its banks and their ports.
///
/// Banks:     entry k of the table lies in bank k mod `banks`.
/// Interval:  each bank has `ports` ports; a port takes an entry's address every ceil(entry bytes / width) cycles.
/// Latency:   an entry's data arrive `latency` cycles after the last of these; a request's with its last entry.
/// Order:     order of the calls. A request starts when each bank it reads has a free port; its further entries take
///            ports as these become free, and can delay the requests after it.
class BankedPorts {
  public:
    BankedPorts(const MemoryTiming& timing, const datapath::TableLayout& layout)
        : base_(layout.base),
          entry_bytes_(layout.entry_bytes),
          ports_(timing.ports),
          banks_(timing.banks),
          latency_(timing.latency),
          slots_per_entry_(timing.width == 0 ? 1 : (layout.entry_bytes + timing.width - 1) / timing.width),
          port_free_(std::size_t{timing.banks} * timing.ports),
          bank_slots_(timing.banks) {}

    /// The first cycle in which the entries at these addresses can be read; a past cycle: at once.
    std::uint64_t ready(const std::uint64_t* addresses, unsigned count) const {
        if (banks_ == 1)
            return port_free_[first_free_port(0)];
        std::uint64_t cycle = 0;
        for (unsigned k = 0; k < count; ++k)
            cycle = std::max(cycle, port_free_[first_free_port(bank_of(addresses[k]))]);
        return cycle;
    }

    /// Reads the entries, from `cycle` on, as ports become free. Returns the cycle of the last entry's data.
    std::uint64_t serve(const std::uint64_t* addresses, unsigned count, std::uint64_t cycle) {
        std::uint64_t last = cycle;
        for (unsigned k = 0; k < count; ++k) {
            const std::size_t bank = bank_of(addresses[k]);
            std::uint64_t& free = port_free_[first_free_port(bank)];
            free = std::max(free, cycle) + slots_per_entry_;
            bank_slots_[bank] += slots_per_entry_;
            last = std::max(last, free - 1);
        }
        slots_taken_ += std::uint64_t{count} * slots_per_entry_;
        return last + latency_;
    }

    unsigned latency() const { return latency_; }
    /// Port slots taken: entries times the cycles a port needs for one.
    std::uint64_t slots_taken() const { return slots_taken_; }
    /// Port slots a cycle, of all banks.
    std::uint64_t slots_per_cycle() const { return std::uint64_t{ports_} * banks_; }
    /// Cycles that the busiest bank's ports needed.
    std::uint64_t occupied_cycles() const { return *std::max_element(bank_slots_.begin(), bank_slots_.end()) / ports_; }

  private:
    std::size_t bank_of(std::uint64_t address) const {
        return banks_ == 1 ? 0 : (address - base_) / entry_bytes_ % banks_;
    }
    std::size_t first_free_port(std::size_t bank) const {
        const auto first = port_free_.begin() + static_cast<std::ptrdiff_t>(bank * ports_);
        return static_cast<std::size_t>(std::min_element(first, first + ports_) - port_free_.begin());
    }

    std::uint64_t base_;
    unsigned entry_bytes_;
    unsigned ports_;
    unsigned banks_;
    unsigned latency_;
    unsigned slots_per_entry_;
    std::vector<std::uint64_t> port_free_;   // bank by bank: the cycle from which the port is free
    std::vector<std::uint64_t> bank_slots_;  // taken so far
    std::uint64_t slots_taken_ = 0;
};

}  // namespace tessera
