#pragma once
#include <array>
#include <cstdint>

namespace tessera::datapath {

/// The table entries that an item needs: byte addresses, grouped in requests that are made one after another. Empty if
/// the item needs no entries. What is added beyond the most is counted but not kept.
class Reads {
  public:
    static constexpr unsigned most_requests = 3;
    static constexpr unsigned most_entries = 27;

    /// Selects the port for the requests added next. Ports are numbered in the order of Stage::reads_through();
    /// initially 0.
    void through(unsigned port) { port_ = port; }
    /// Adds a request for one entry.
    void add(std::uint64_t address) {
        add_request();
        add_entry(address);
    }
    /// Adds a request for the 1 to 9 entries that are added next (a gather).
    void add_request() {
        if (requests_ < most_requests) {
            ports_[requests_] = static_cast<std::uint8_t>(port_);
            first_[requests_] = entries_;
        }
        ++requests_;
    }
    void add_entry(std::uint64_t address) {
        if (entries_ < most_entries)
            address_[entries_] = address;
        ++entries_;
    }
    void clear() { port_ = requests_ = entries_ = 0; }

    unsigned port(unsigned request) const { return ports_[request]; }
    unsigned last_port() const { return port_; }
    unsigned requests() const { return requests_; }
    unsigned entries() const { return entries_; }
    /// The index of a request's first entry, and the number of its entries; addresses() has the entries of all requests
    /// in order.
    unsigned first(unsigned request) const { return first_[request]; }
    unsigned count(unsigned request) const {
        return (request + 1 < requests_ ? first_[request + 1] : entries_) - first_[request];
    }
    const std::uint64_t* addresses() const { return address_.data(); }

  private:
    unsigned port_ = 0;
    unsigned requests_ = 0;
    unsigned entries_ = 0;
    std::array<std::uint8_t, most_requests> ports_;  // of each request
    std::array<unsigned, most_requests> first_;      // its first entry
    std::array<std::uint64_t, most_entries> address_;
};

/// The entries read, in the order of the addresses, zero-extended.
using Entries = std::array<std::uint64_t, Reads::most_entries>;

}  // namespace tessera::datapath
