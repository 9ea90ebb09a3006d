#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "modules/memories/off_chip_memory.h"
#include "modules/sockets/memory_port.h"
#include "testbench/tests/support/memory_protocol.h"
#include "testbench/tests/support/timed_modules.h"

// Off-chip memory, cycle by cycle, and a port that writes and reads it.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_PS;
using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;
using Cycles = std::vector<std::uint64_t>;

namespace {

const sc_time period(10, SC_PS);

/// Off-chip memory of 1000 bytes and a port for records of 40 bytes, 8 of which take no time.
struct OffChipBench : sc_core::sc_module {
    CycleScheduler clock{"clock", period};
    OffChipMemory memory;
    Caller owner{clock};
    MemoryPort port{"port", 40, false};
    std::vector<std::pair<bool, std::uint64_t>> wanted;  ///< write?, address; each made as soon as it may
    Cycles offered, answered;
    std::vector<int> read_values;

    OffChipBench(const sc_core::sc_module_name& name, const OffChipTiming& timing, const StallParameters& stalls = {})
        : sc_module(name), memory("memory", clock, timing, stalls, 1000, 8) {
        clock.attach(memory);
        port.clocked_by(clock, owner, 16, 1);
        port.bind(memory);
        owner.on_step = [this] { step(); };
    }
    void run() {
        clock.wake_at(owner, 10);
        sc_core::sc_start();
        memory.activity().finish(clock.last_cycle() + 1);
        CHECK(answered.size() == wanted.size());
    }

  private:
    void step() {
        while (port.answered()) {
            answered.push_back(clock.cycle());
            if (port.answer_is_read())
                read_values.push_back(port.answer()[0]);
            port.pop_answer();
        }
        while (offered.size() < wanted.size() && port.may_request()) {
            const auto [write, address] = wanted[offered.size()];
            offered.push_back(clock.cycle());
            if (write) {
                std::fill_n(port.entry_to_write(), 40, static_cast<unsigned char>(offered.size()));
                port.write(address);
            } else {
                port.request(address);
            }
        }
    }
};

}  // namespace

TEST_CASE("off-chip memory: bandwidth, latency, and one channel for both directions") {
    // 32 bytes at 5 per cycle: 7 cycles each, one after another from 10; answered 20 after the last byte
    OffChipBench bench("bench", {20, 5, 4});
    bench.wanted = {{true, 0}, {true, 40}, {false, 40}, {true, 0}, {false, 0}, {false, 80}};
    bench.run();
    CHECK(bench.answered == Cycles{37, 44, 51, 58, 65, 72});
    CHECK(bench.read_values == std::vector<int>{2, 4, 0});  // never written: zero
    CHECK(bench.memory.bytes_written() == 3 * 32);
    CHECK(bench.memory.bytes_read() == 3 * 32);
    CHECK(bench.memory.occupied_cycles() == 6 * 7);
    CHECK(bench.memory.activity().cycles_in(State::busy) == 6 * 7);
    CHECK(bench.memory.activity().items_out() == 6);
}

TEST_CASE("off-chip memory: latency 0, one cycle for a record as wide as the channel") {
    OffChipBench bench("bench", {0, 32, 1});
    bench.wanted = {{true, 0}, {false, 0}, {true, 0}, {false, 0}};
    bench.run();
    CHECK(bench.answered == Cycles{11, 12, 13, 14});
    CHECK(bench.read_values == std::vector<int>{1, 3});
}

TEST_CASE("off-chip memory: a full buffer withholds END_REQ") {
    // 4 cycles each: one served in cycle 10, two in the buffer, the fourth offered until 14, the fifth until 18
    OffChipBench bench("bench", {1, 8, 2});
    bench.wanted = std::vector<std::pair<bool, std::uint64_t>>(6, {true, 0});
    bench.run();
    CHECK(bench.offered == Cycles{10, 10, 10, 10, 14, 18});
}

TEST_CASE("off-chip memory: random stalls change no answer") {
    OffChipBench bench("bench", {3, 16, 2}, {5, 500, 20});
    for (int k = 0; k < 100; ++k)
        for (const bool write : {true, false})
            bench.wanted.emplace_back(write, static_cast<std::uint64_t>(k % 25 * 40));
    bench.run();
    REQUIRE(bench.read_values.size() == 100);
    for (int k = 0; k < 100; ++k)
        REQUIRE(bench.read_values[static_cast<std::size_t>(k)] == (2 * k + 1) % 256);
    CHECK(bench.clock.last_cycle() > 10 + 200 * 2 + 100);
}

TEST_CASE("off-chip memory: an access beyond its size is an error that names the port") {
    OffChipBench bench("bench", {1, 8, 2});
    bench.wanted = {{true, 960}, {true, 961}};
    CHECK_THAT(error_of([&] { bench.run(); }),
               Contains("bench.port") && Contains("0x3c1") && Contains("TLM_ADDRESS_ERROR_RESPONSE"));
    CHECK(bench.answered.size() == 1);
}

TEST_CASE("off-chip memory: an access that begins beyond its size is an error") {
    OffChipBench bench("bench", {1, 8, 2});
    bench.wanted = {{false, 1001}};
    CHECK_THAT(error_of([&] { bench.run(); }), Contains("0x3e9") && Contains("TLM_ADDRESS_ERROR_RESPONSE"));
}

TEST_CASE("off-chip memory: a long latency has many answers in flight, in order") {
    CycleScheduler clock("clock", period);
    OffChipMemory memory("memory", clock, {1000, 8, 64}, {}, 1000, 8);
    clock.attach(memory);
    Initiator initiator("initiator");
    initiator.socket.bind(memory.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    unsigned char data[8] = {};
    std::vector<MemoryRequest> requests;
    for (unsigned k = 0; k < 50; ++k)
        requests.push_back(read_of(data, 8 * k, 8));  // not longer than the part that takes no time: counted whole
    for (MemoryRequest& request : requests)
        initiator.send(request, tlm::BEGIN_REQ);
    sc_core::sc_start();
    REQUIRE(initiator.back.size() == 50);
    for (std::size_t k = 0; k < 50; ++k) {
        CHECK(initiator.back[k].first == tlm::BEGIN_RESP);
        CHECK(initiator.back[k].second == &requests[k]);
    }
    CHECK(memory.activity().high_water_mark() == 50);
    CHECK(clock.last_cycle() == 50 + 1000);
    CHECK(memory.bytes_read() == 50 * 8);
}

TEST_CASE("off-chip memory: a command other than read or write, and an initiator's protocol violations") {
    CycleScheduler clock("clock", period);
    OffChipMemory memory("memory", clock, {1, 8, 1}, {}, 1000, 8);
    clock.attach(memory);
    Initiator initiator("initiator");
    initiator.socket.bind(memory.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    unsigned char data[40] = {};
    MemoryRequest first = read_of(data, 0, 40);
    MemoryRequest second = first;
    MemoryRequest third = first;
    CHECK_THAT(error_of([&] { initiator.send(first, tlm::END_RESP); }),
               Contains("memory.socket") && Contains("other than BEGIN_REQ"));
    first.command = tlm::TLM_IGNORE_COMMAND;
    CHECK(initiator.send(first, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
    CHECK(initiator.send(second, tlm::BEGIN_REQ) == tlm::TLM_ACCEPTED);
    CHECK_THAT(error_of([&] { initiator.send(third, tlm::BEGIN_REQ); }),
               Contains("memory.socket") && Contains("BEGIN_REQ before END_REQ"));
    sc_core::sc_start();
    CHECK(first.response == tlm::TLM_COMMAND_ERROR_RESPONSE);
    CHECK(second.response == tlm::TLM_OK_RESPONSE);
    initiator.reply = tlm::TLM_ACCEPTED;
    CHECK(initiator.send(third, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains("memory.socket") && Contains("BEGIN_RESP was not completed"));
}

TEST_CASE("off-chip memory: b_transport adds the latency, unless the access fails") {
    OffChipBench bench("bench", {20, 5, 4});
    sc_core::sc_start(SC_ZERO_TIME);
    unsigned char data[40] = {7};
    MemoryRequest write{tlm::TLM_WRITE_COMMAND, 1, 40, {80}, data};
    sc_time delay(3, SC_PS);
    bench.port.socket->b_transport(write, delay);
    CHECK(write.is_ok());
    CHECK(delay == sc_time(203, SC_PS));
    unsigned char back[40] = {};
    MemoryRequest read = read_of(back, 80, 40);
    CHECK(bench.port.socket->transport_dbg(read) == 40);
    CHECK(back[0] == 7);
    MemoryRequest beyond = read_of(back, 961, 40);
    bench.port.socket->b_transport(beyond, delay);
    CHECK(beyond.response == tlm::TLM_ADDRESS_ERROR_RESPONSE);
    CHECK(delay == sc_time(203, SC_PS));
}
