#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "modules/memory/off_chip_memory.h"
#include "modules/memory/store_port.h"
#include "testbench/tests/memory_protocol.h"
#include "testbench/tests/timed_modules.h"

// Off-chip memory to the cycle, and the port that writes and reads it: the protocol, and breaches by either side.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_PS;
using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;
using Cycles = std::vector<std::uint64_t>;

namespace {

const sc_time period(10, SC_PS);

/// Off-chip memory of 1000 bytes and a port for records of 40 bytes, of which 8 take no time.
struct OffChipBench : sc_core::sc_module {
    Clock clock{"clock", period};
    OffChipMemory memory;
    Caller owner{clock};
    StorePort port{"port", clock, owner, 40, 16};
    std::vector<std::pair<bool, std::uint64_t>> wanted;  ///< write?, address; each made as soon as it may
    Cycles offered, answered;
    std::vector<int> read_values;

    OffChipBench(const sc_core::sc_module_name& name, const OffChipTiming& timing,
                 const StallParameters& stalls = {})
        : sc_module(name), memory("memory", clock, timing, stalls, 1000, 8) {
        clock.attach(memory);
        port.socket.bind(memory.socket);
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
                std::fill_n(port.record_to_write(), 40, static_cast<unsigned char>(offered.size()));
                port.write(address);
            } else {
                port.read(address);
            }
        }
    }
};

}  // namespace

TEST_CASE("off-chip memory: bandwidth, latency, and one channel for both directions") {
    // 32 bytes at 5 a cycle: 7 cycles each, one after another from 10 on; answered 20 after the last byte
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

TEST_CASE("off-chip memory: latency 0, a cycle for what fits into one") {
    OffChipBench bench("bench", {0, 32, 1});
    bench.wanted = {{true, 0}, {false, 0}, {true, 0}, {false, 0}};
    bench.run();
    CHECK(bench.answered == Cycles{11, 12, 13, 14});
    CHECK(bench.read_values == std::vector<int>{1, 3});
}

TEST_CASE("off-chip memory: a full buffer withholds END_REQ") {
    // 4 cycles each: one served in cycle 10, two in the buffer, the fourth on offer until 14, the fifth until 18
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

TEST_CASE("off-chip memory: an access that begins beyond its size is an error, too") {
    OffChipBench bench("bench", {1, 8, 2});
    bench.wanted = {{false, 1001}};
    CHECK_THAT(error_of([&] { bench.run(); }), Contains("0x3e9") && Contains("TLM_ADDRESS_ERROR_RESPONSE"));
}

TEST_CASE("off-chip memory: as many answers under way as the latency asks for, in order") {
    Clock clock("clock", period);
    OffChipMemory memory("memory", clock, {1000, 8, 64}, {}, 1000, 8);
    clock.attach(memory);
    Initiator initiator("initiator");
    initiator.socket.bind(memory.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    Manager manager;
    unsigned char data[8] = {};
    std::vector<std::unique_ptr<Transaction>> payloads;
    for (unsigned k = 0; k < 50; ++k) {
        payloads.push_back(std::make_unique<Transaction>(&manager));
        payloads.back()->acquire();
        make_read(*payloads.back(), data, 8 * k, 8);  // no longer than what takes no time: counted whole
        initiator.send(*payloads.back(), tlm::BEGIN_REQ);
    }
    sc_core::sc_start();
    REQUIRE(initiator.back.size() == 50);
    for (std::size_t k = 0; k < 50; ++k) {
        CHECK(initiator.back[k].first == tlm::BEGIN_RESP);
        CHECK(initiator.back[k].second == payloads[k].get());
    }
    CHECK(memory.activity().high_water_mark() == 50);
    CHECK(clock.last_cycle() == 50 + 1000);
    CHECK(memory.bytes_read() == 50 * 8);
}

TEST_CASE("off-chip memory: a command that is neither read nor write, and breaches of an initiator") {
    Clock clock("clock", period);
    OffChipMemory memory("memory", clock, {1, 8, 1}, {}, 1000, 8);
    clock.attach(memory);
    Initiator initiator("initiator");
    initiator.socket.bind(memory.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    Manager manager;
    unsigned char data[40] = {};
    Transaction payload(&manager), second(&manager), third(&manager);
    for (Transaction* it : {&payload, &second, &third}) {
        it->acquire();
        make_read(*it, data, 0, 40);
    }
    CHECK_THAT(error_of([&] { initiator.send(payload, tlm::END_RESP); }),
               Contains("memory.socket") && Contains("other than BEGIN_REQ"));
    payload.set_command(tlm::TLM_IGNORE_COMMAND);
    CHECK(initiator.send(payload, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
    CHECK(initiator.send(second, tlm::BEGIN_REQ) == tlm::TLM_ACCEPTED);
    CHECK_THAT(error_of([&] { initiator.send(third, tlm::BEGIN_REQ); }),
               Contains("memory.socket") && Contains("BEGIN_REQ before END_REQ"));
    sc_core::sc_start();
    CHECK(payload.get_response_status() == tlm::TLM_COMMAND_ERROR_RESPONSE);
    CHECK(second.get_response_status() == tlm::TLM_OK_RESPONSE);
    initiator.reply = tlm::TLM_ACCEPTED;
    CHECK(initiator.send(third, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains("memory.socket") && Contains("BEGIN_RESP was not completed"));
}

TEST_CASE("store port: breaches of a memory are errors that name the port") {
    Clock clock("clock", period);
    Caller owner(clock);
    struct Owner : sc_core::sc_module {
        StorePort port;
        Owner(const sc_core::sc_module_name& name, Clock& its_clock, Clocked& unit)
            : sc_module(name), port("port", its_clock, unit, 40, 4) {}
    } unit("unit", clock, owner);
    Target target("target");
    unit.port.socket.bind(target.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    Transaction stranger;
    const auto breach = [&](Transaction& payload, tlm::tlm_phase phase) {
        return error_of([&] { target.send_back(payload, phase); });
    };
    CHECK_THAT(breach(stranger, tlm::END_REQ), Contains("unit.port") && Contains("not on offer"));
    CHECK_THAT(breach(stranger, tlm::BEGIN_RESP), Contains("unit.port") && Contains("was not made"));
    unit.port.read(0);
    target.status = tlm::TLM_ACCEPTED;
    unit.port.write(40);
    CHECK_THAT(error_of([&] { unit.port.write(80); }),
               Contains("unit.port") && Contains("BEGIN_REQ before END_REQ"));
    CHECK_THAT(breach(*target.come[1], tlm::BEGIN_RESP), Contains("out of order or before END_REQ"));
    CHECK_THAT(breach(*target.come[0], tlm::END_RESP), Contains("no memory may send"));
    CHECK_THAT(breach(stranger, tlm::END_REQ), Contains("unit.port") && Contains("not on offer"));
    target.come[0]->set_response_status(tlm::TLM_OK_RESPONSE);
    CHECK(breach(*target.come[0], tlm::BEGIN_RESP).empty());
    CHECK_THAT(breach(*target.come[1], tlm::BEGIN_RESP), Contains("before END_REQ"));
    CHECK(unit.port.answered());
    unit.port.pop_answer();
    CHECK(breach(*target.come[1], tlm::END_REQ).empty());
    for (const auto& [status, phase] : std::vector<std::pair<tlm::tlm_sync_enum, tlm::tlm_phase>>{
             {tlm::TLM_COMPLETED, tlm::END_REQ}, {tlm::TLM_UPDATED, tlm::BEGIN_RESP}}) {
        target.status = status;
        target.phase_back = phase;
        CHECK_THAT(error_of([&] { unit.port.read(0); }),
                   Contains("unit.port") && Contains("answered by neither"));
    }
}
