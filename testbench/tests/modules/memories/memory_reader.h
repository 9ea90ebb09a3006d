#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/sockets/memory_port.h"
#include "testbench/tests/support/timed_modules.h"

namespace tessera::testing {

/// A unit that makes each of its reads as early as possible from a given cycle, and records when they were offered and
/// answered.
struct MemoryReader : sc_core::sc_module {
    MemoryPort port;
    std::vector<std::vector<std::uint32_t>> reads;  ///< entries of each request
    std::uint64_t base = 0, entry_bytes = 1;        ///< entry k is at base + k * entry_bytes
    std::uint64_t from = 10;
    std::vector<std::uint64_t> offered, answered;
    std::vector<std::uint64_t> values;

    MemoryReader(const sc_core::sc_module_name& name, CycleScheduler& clock, std::size_t most_under_way,
                 bool direct_access)
        : sc_module(name), port("port", 4, direct_access), clock_(clock), caller_(clock) {
        port.clocked_by(clock, caller_, most_under_way);
        caller_.on_step = [this] { step(); };
    }

    /// Writes 3 * k + 1 to each entry k, of four bytes.
    void fill(std::uint32_t entries) {
        for (std::uint32_t entry = 0; entry < entries; ++entry) {
            std::uint32_t value = 3 * entry + 1;
            MemoryRequest request{
                tlm::TLM_WRITE_COMMAND, 1, 4, {base + entry * entry_bytes}, reinterpret_cast<unsigned char*>(&value)};
            REQUIRE(port.socket->transport_dbg(request) == 4);
        }
    }
    /// Requires that all reads were answered with the written values.
    void check_values() const {
        CHECK(answered.size() == reads.size());
        std::size_t place = 0;
        for (const auto& entries_read : reads)
            for (const std::uint32_t entry : entries_read)
                REQUIRE(values.at(place++) == 3 * entry + 1);
    }

  private:
    void start_of_simulation() override { clock_.wake_at(caller_, from); }
    void step() {
        while (port.answered()) {
            answered.push_back(clock_.cycle());
            for (std::size_t k = 0; k < reads[answered.size() - 1].size(); ++k)
                values.push_back(port.entry(static_cast<unsigned>(k)));
            port.pop_answer();
        }
        while (clock_.cycle() >= from && offered.size() < reads.size() && port.may_request()) {
            std::vector<std::uint64_t> addresses;
            for (const std::uint32_t entry : reads[offered.size()])
                addresses.push_back(base + entry * entry_bytes);
            offered.push_back(clock_.cycle());
            port.request(addresses.data(), static_cast<unsigned>(addresses.size()));
        }
    }

    CycleScheduler& clock_;
    Caller caller_;
};

}  // namespace tessera::testing
