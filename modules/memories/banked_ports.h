#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/memories/interleave.h"
#include "modules/timing/timing.h"

namespace tessera {

/// The timing of a table's reads: its banks and their ports.
///
/// Banks:     interleave.h.
/// Interval:  each bank has `ports` ports; a port accepts an entry's address every ceil(entry bytes / width) cycles.
/// Latency:   an entry's data arrive `latency` cycles after the last of these; a request's with its last entry.
/// Order:     order of the calls. Without a window a request starts when each bank it reads has a free port. With a
///            window of n it starts when the n-th request before it has sent its last address: reads of up to n
///            requests overlap. Addresses wait for a port of their bank in order, and can delay later requests.
///            (Decision: out of order, requests would need tags and a reorder buffer; ports reserved for future cycles
///            would be a buffer without cost.)
class BankedPorts {
  public:
    BankedPorts(const MemoryTiming& timing, const datapath::TableLayout& layout)
        : bank_of_(timing, layout),
          ports_(timing.ports),
          banks_(timing.banks),
          latency_(timing.latency),
          slots_per_entry_(timing.width == 0 ? 1 : (layout.entry_bytes + timing.width - 1) / timing.width),
          port_free_(std::size_t{timing.banks} * timing.ports),
          bank_slots_(timing.banks),
          window_(timing.window) {}

    /// The first cycle in which the entries at these addresses can be read; a past cycle means at once.
    std::uint64_t ready(const std::uint64_t* addresses, unsigned count) const {
        if (!window_.empty())
            return window_[oldest_];
        if (banks_ == 1)
            return port_free_[first_free_port(0)];
        std::uint64_t cycle = 0;
        for (unsigned k = 0; k < count; ++k)
            cycle = std::max(cycle, port_free_[first_free_port(bank_of_(addresses[k]))]);
        return cycle;
    }

    /// Reads at least one entry, from `cycle` on, as ports become free. Returns the cycle of the last entry's data.
    std::uint64_t serve(const std::uint64_t* addresses, unsigned count, std::uint64_t cycle) {
        const std::uint64_t last = send(addresses, count, cycle);
        slots_taken_ += std::uint64_t{count} * slots_per_entry_;
        if (!window_.empty()) {
            window_[oldest_] = last + 1;
            oldest_ = oldest_ + 1 == window_.size() ? 0 : oldest_ + 1;
        }
        return last + latency_;
    }

    /// Sets the table's number of columns.
    void lay_out(std::uint32_t columns) { bank_of_.lay_out(columns); }

    unsigned latency() const { return latency_; }
    /// Port slots taken: entries times the cycles a port needs for one.
    std::uint64_t slots_taken() const { return slots_taken_; }
    /// Port slots per cycle, of all banks.
    std::uint64_t slots_per_cycle() const { return std::uint64_t{ports_} * banks_; }
    /// Cycles that the busiest bank's ports needed.
    std::uint64_t occupied_cycles() const { return *std::max_element(bank_slots_.begin(), bank_slots_.end()) / ports_; }

  private:
    /// Returns the last cycle in which the entries' addresses occupy a port.
    std::uint64_t send(const std::uint64_t* addresses, unsigned count, std::uint64_t cycle) {
        if (port_free_.size() == 1) {
            const std::uint64_t slots = std::uint64_t{count} * slots_per_entry_;
            port_free_[0] = std::max(port_free_[0], cycle) + slots;
            bank_slots_[0] += slots;
            return port_free_[0] - 1;
        }
        std::uint64_t last = cycle;
        for (unsigned k = 0; k < count; ++k) {
            const std::size_t bank = bank_of_(addresses[k]);
            std::uint64_t& free = port_free_[first_free_port(bank)];
            free = std::max(free, cycle) + slots_per_entry_;
            bank_slots_[bank] += slots_per_entry_;
            last = std::max(last, free - 1);
        }
        return last;
    }
    std::size_t first_free_port(std::size_t bank) const {
        if (ports_ == 1)
            return bank;
        const auto first = port_free_.begin() + static_cast<std::ptrdiff_t>(bank * ports_);
        return static_cast<std::size_t>(std::min_element(first, first + ports_) - port_free_.begin());
    }

    BankOfEntry bank_of_;
    unsigned ports_;
    unsigned banks_;
    unsigned latency_;
    unsigned slots_per_entry_;
    std::vector<std::uint64_t> port_free_;   // bank by bank: the cycle from which each port is free
    std::vector<std::uint64_t> bank_slots_;  // taken so far
    std::uint64_t slots_taken_ = 0;
    std::vector<std::uint64_t> window_;  // for each request in the window: the cycle after its last address
    std::size_t oldest_ = 0;             // the oldest of these
};

}  // namespace tessera
