#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

namespace tessera {

/// The table entries that a unit's item needs: byte addresses, in requests that a memory serves one after another. To
/// be filled in by the unit; empty: none.
class Reads {
  public:
    static constexpr unsigned most_requests = 3;
    static constexpr unsigned most_entries = 27;

    /// One more request, for one entry.
    void add(std::uint64_t address) { add(&address, 1); }
    /// One more request, for 1 to 9 entries together (a gather).
    void add(const std::uint64_t* addresses, unsigned count) {
        std::copy_n(addresses, count, address_.begin() + entries_);
        count_[requests_++] = count;
        entries_ += count;
    }

    unsigned requests() const { return requests_; }
    unsigned entries() const { return entries_; }
    /// Entries of a request; of all, their addresses in order.
    unsigned count(unsigned request) const { return count_[request]; }
    const std::uint64_t* addresses() const { return address_.data(); }

  private:
    unsigned requests_ = 0;
    unsigned entries_ = 0;
    std::array<unsigned, most_requests> count_;
    std::array<std::uint64_t, most_entries> address_;
};

/// What was read, in the order of the addresses, zero-extended.
using Entries = std::array<std::uint64_t, Reads::most_entries>;

}  // namespace tessera
