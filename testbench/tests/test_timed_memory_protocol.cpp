#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "modules/memory/memory_port.h"
#include "modules/memory/off_chip_memory.h"
#include "modules/memory/store_port.h"
#include "modules/memory/table_memory.h"
#include "testbench/tests/timed_modules.h"

// The memories' sockets: base protocol responses, breaches by either side, and off-chip memory to the cycle.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_PS;
using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;
using Cycles = std::vector<std::uint64_t>;
using Transaction = tlm::tlm_generic_payload;

namespace {

const sc_time period(10, SC_PS);
const datapath::TableLayout layout{4096, 16, 16, 4};

/// The reuse of payloads is the test's own matter.
struct Manager : tlm::tlm_mm_interface {
    void free(Transaction*) override {}
};

/// An initiator whose phases are the test's.
struct Initiator : sc_core::sc_module {
    tlm_utils::simple_initiator_socket<Initiator> socket{"socket"};
    std::vector<std::pair<tlm::tlm_phase, Transaction*>> back;
    tlm::tlm_sync_enum reply = tlm::TLM_COMPLETED;

    explicit Initiator(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_nb_transport_bw(this, &Initiator::nb_transport_bw);
    }
    tlm::tlm_sync_enum send(Transaction& payload, tlm::tlm_phase phase, sc_time delay = SC_ZERO_TIME) {
        return socket->nb_transport_fw(payload, phase, delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_bw(Transaction& payload, tlm::tlm_phase& phase, sc_time&) {
        back.emplace_back(phase, &payload);
        return phase == tlm::BEGIN_RESP ? reply : tlm::TLM_ACCEPTED;
    }
};

/// A target whose phases are the test's; keeps what it is sent.
struct Target : sc_core::sc_module {
    tlm_utils::passthrough_target_socket<Target> socket{"socket"};
    std::vector<Transaction*> come;
    tlm::tlm_sync_enum status = tlm::TLM_UPDATED;
    tlm::tlm_phase phase_back = tlm::END_REQ;

    explicit Target(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_nb_transport_fw(this, &Target::nb_transport_fw);
    }
    tlm::tlm_sync_enum send_back(Transaction& payload, tlm::tlm_phase phase, sc_time delay = SC_ZERO_TIME) {
        return socket->nb_transport_bw(payload, phase, delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_fw(Transaction& payload, tlm::tlm_phase& phase, sc_time&) {
        come.push_back(&payload);
        phase = phase_back;
        return status;
    }
};

void make_read(Transaction& payload, unsigned char* data, std::uint64_t address, unsigned length = 4) {
    payload.set_command(tlm::TLM_READ_COMMAND);
    payload.set_address(address);
    payload.set_data_ptr(data);
    payload.set_data_length(length);
    payload.set_streaming_width(length);
    payload.set_byte_enable_ptr(nullptr);
    payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
}

struct TableBench {
    Clock clock{"clock", period};
    TableMemory memory{"memory", clock, layout, MemoryTiming{}, {}};
    Initiator initiator{"initiator"};
    Manager manager;
    unsigned char data[64] = {};

    TableBench() {
        clock.attach(memory);
        initiator.socket.bind(memory.socket);
        sc_core::sc_start(SC_ZERO_TIME);
    }

    /// Blocking and non-blocking transport must give the same response.
    void expect(Transaction& payload, tlm::tlm_response_status expected) {
        payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
        sc_time delay(5, SC_PS);
        initiator.socket->b_transport(payload, delay);
        CHECK(payload.get_response_status() == expected);
        CHECK(delay == sc_time(expected == tlm::TLM_OK_RESPONSE ? 15 : 5, SC_PS));

        payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
        initiator.back.clear();
        payload.acquire();
        CHECK(initiator.send(payload, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
        sc_core::sc_start();
        REQUIRE(initiator.back.size() == 1);
        CHECK(initiator.back[0].first == tlm::BEGIN_RESP);
        CHECK(payload.get_response_status() == expected);
        payload.release();
        CHECK(payload.get_ref_count() == 0);
    }
};

}  // namespace

TEST_CASE("table memory: every response of the base protocol, blocking and non-blocking") {
    TableBench bench;
    Transaction payload(&bench.manager);
    make_read(payload, bench.data, layout.base);
    bench.expect(payload, tlm::TLM_OK_RESPONSE);
    make_read(payload, bench.data, layout.base + layout.bytes() - 4);
    bench.expect(payload, tlm::TLM_OK_RESPONSE);
    const std::uint64_t counted = bench.memory.transactions();
    CHECK(counted == 4);

    for (const std::uint64_t outside :
         {layout.base - 1, layout.base - 4, layout.base + layout.bytes() - 3, layout.base + layout.bytes(),
          std::uint64_t{0}, ~std::uint64_t{0} - 2}) {
        make_read(payload, bench.data, outside);
        bench.expect(payload, tlm::TLM_ADDRESS_ERROR_RESPONSE);
    }
    make_read(payload, bench.data, layout.base);
    payload.set_command(tlm::TLM_WRITE_COMMAND);
    bench.expect(payload, tlm::TLM_COMMAND_ERROR_RESPONSE);
    payload.set_command(tlm::TLM_IGNORE_COMMAND);
    bench.expect(payload, tlm::TLM_COMMAND_ERROR_RESPONSE);
    make_read(payload, bench.data, layout.base);
    payload.set_streaming_width(2);
    bench.expect(payload, tlm::TLM_BURST_ERROR_RESPONSE);
    make_read(payload, bench.data, layout.base);
    unsigned char enable[4] = {0xff, 0xff, 0xff, 0xff};
    payload.set_byte_enable_ptr(enable);
    payload.set_byte_enable_length(4);
    bench.expect(payload, tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
    CHECK(bench.memory.transactions() == counted);  // only what was read
}

TEST_CASE("table memory: a gather with one address outside is an address error") {
    TableBench bench;
    Transaction payload(&bench.manager);
    make_read(payload, bench.data, layout.base, 16);
    GatherExtension gather;
    gather.count = 4;
    gather.address = {layout.base, layout.base + 4, layout.base + layout.bytes(), layout.base + 8};
    payload.set_extension(&gather);
    bench.expect(payload, tlm::TLM_ADDRESS_ERROR_RESPONSE);
    gather.address[2] = layout.base + layout.bytes() - 4;
    bench.expect(payload, tlm::TLM_OK_RESPONSE);
    payload.clear_extension(&gather);
}

TEST_CASE("table memory: the delay of a request is added before it is served") {
    TableBench bench;
    Transaction payload(&bench.manager);
    payload.acquire();
    make_read(payload, bench.data, layout.base);
    // 25 ps on: in cycle 3; answered a latency of 1 later
    CHECK(bench.initiator.send(payload, tlm::BEGIN_REQ, sc_time(25, SC_PS)) == tlm::TLM_ACCEPTED);
    sc_core::sc_start(sc_time(29, SC_PS));
    CHECK(bench.initiator.back.empty());
    sc_core::sc_start(sc_time(2, SC_PS));
    REQUIRE(bench.initiator.back.size() == 1);
    CHECK(bench.initiator.back[0].first == tlm::END_REQ);
    sc_core::sc_start();
    REQUIRE(bench.initiator.back.size() == 2);
    CHECK(bench.clock.last_cycle() == 4);
}

TEST_CASE("table memory: breaches of an initiator are errors that name the memory's socket") {
    TableBench bench;
    Transaction payload(&bench.manager), second(&bench.manager), third(&bench.manager),
        fourth(&bench.manager);
    for (Transaction* it : {&payload, &second, &third, &fourth}) {
        it->acquire();
        make_read(*it, bench.data, layout.base);
    }
    for (const tlm::tlm_phase& phase :
         {tlm::tlm_phase(tlm::END_REQ), tlm::tlm_phase(tlm::BEGIN_RESP), tlm::tlm_phase(tlm::END_RESP)})
        CHECK_THAT(error_of([&] { bench.initiator.send(payload, phase); }),
                   Contains("memory.socket") && Contains("other than BEGIN_REQ"));
    CHECK(bench.initiator.send(payload, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);  // in the buffer
    CHECK(bench.initiator.send(second, tlm::BEGIN_REQ) == tlm::TLM_ACCEPTED);  // at the door
    CHECK_THAT(error_of([&] { bench.initiator.send(third, tlm::BEGIN_REQ); }),
               Contains("memory.socket") && Contains("BEGIN_REQ before END_REQ"));
    bench.initiator.reply = tlm::TLM_ACCEPTED;  // wants to end the response itself
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains("memory.socket") && Contains("BEGIN_RESP was not completed"));
}

namespace {

/// A MemoryPort of three requests before a target that the test plays.
struct PortBench : sc_core::sc_module {
    Clock clock{"clock", period};
    MemoryPort port{"port", 4, false};
    Target target{"target"};
    Caller owner{clock};
    Cycles called;
    std::uint64_t addresses[4] = {100, 104, 108, 112};

    explicit PortBench(const sc_core::sc_module_name& name) : sc_module(name) {
        port.clocked_by(clock, owner, 3);
        port.socket.bind(target.socket);
        owner.on_step = [this] { called.push_back(clock.cycle()); };
    }
    void answer(std::size_t k, tlm::tlm_response_status response = tlm::TLM_OK_RESPONSE) {
        target.come[k]->set_response_status(response);
        target.send_back(*target.come[k], tlm::BEGIN_RESP);
    }
};

}  // namespace

TEST_CASE("memory port: exclusion, requests under way, answers in order") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.port.request(bench.addresses, 1);
    bench.port.request(bench.addresses, 4);
    CHECK(bench.port.may_request());
    bench.target.status = tlm::TLM_ACCEPTED;
    bench.target.phase_back = tlm::BEGIN_REQ;
    bench.port.request(bench.addresses + 2, 1);
    CHECK(bench.port.on_offer());
    CHECK_FALSE(bench.port.may_request());
    REQUIRE(bench.target.come.size() == 3);
    CHECK(bench.target.come[1]->get_data_length() == 16);
    CHECK(bench.target.come[2]->get_address() == 108);
    CHECK_FALSE(bench.port.answered());
    bench.answer(0);
    CHECK(bench.port.answered());
    bench.port.pop_answer();
    CHECK_FALSE(bench.port.answered());
    CHECK_FALSE(bench.port.may_request());  // one is still on offer
    bench.target.send_back(*bench.target.come[2], tlm::END_REQ);
    CHECK(bench.port.may_request());
    bench.answer(1);
    bench.answer(2);
    bench.port.pop_answer();
    bench.port.pop_answer();
    CHECK_FALSE(bench.port.under_way());
    CHECK(bench.port.reads() == 6);
    for (const Transaction* payload : bench.target.come)
        CHECK(payload->get_ref_count() == 0);
}

TEST_CASE("memory port: the delay of an answer is added before the owner is called") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.port.request(bench.addresses, 1);
    bench.target.come[0]->set_response_status(tlm::TLM_OK_RESPONSE);
    bench.target.send_back(*bench.target.come[0], tlm::BEGIN_RESP, sc_time(31, SC_PS));
    sc_core::sc_start();
    CHECK(bench.called == Cycles{4});
}

TEST_CASE("memory port: breaches of a memory are errors that name the port") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    Target& target = bench.target;
    Transaction stranger;
    const auto breach = [&](Transaction& payload, tlm::tlm_phase phase) {
        return error_of([&] { target.send_back(payload, phase); });
    };
    CHECK_THAT(breach(stranger, tlm::BEGIN_RESP), Contains("bench.port") && Contains("was not made"));
    CHECK_THAT(breach(stranger, tlm::END_REQ), Contains("bench.port") && Contains("not on offer"));
    bench.port.request(bench.addresses, 1);
    bench.port.request(bench.addresses + 1, 1);
    CHECK_THAT(breach(*target.come[0], tlm::END_REQ), Contains("not on offer"));  // it was ended by return
    CHECK_THAT(breach(*target.come[1], tlm::BEGIN_RESP), Contains("bench.port") && Contains("out of order"));
    for (const tlm::tlm_phase& phase : {tlm::tlm_phase(tlm::BEGIN_REQ), tlm::tlm_phase(tlm::END_RESP)})
        CHECK_THAT(breach(*target.come[0], phase), Contains("bench.port") && Contains("no memory may send"));
    bench.answer(0);
    bench.answer(1);
    target.status = tlm::TLM_ACCEPTED;
    bench.port.request(bench.addresses + 2, 1);
    CHECK_THAT(breach(*target.come[2], tlm::BEGIN_RESP), Contains("before END_REQ"));
    CHECK_THAT(breach(stranger, tlm::END_REQ), Contains("not on offer"));
    CHECK_THAT(error_of([&] { bench.port.request(bench.addresses, 1); }),
               Contains("bench.port") && Contains("BEGIN_REQ before END_REQ"));
}

TEST_CASE("memory port: an answer by return that is none is an error") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.target.status = tlm::TLM_COMPLETED;
    CHECK_THAT(error_of([&] { bench.port.request(bench.addresses, 1); }),
               Contains("bench.port") && Contains("answered by neither"));
}

TEST_CASE("memory port: an error response is an error that names port, address and response") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.port.request(bench.addresses + 2, 1);
    CHECK_THAT(error_of([&] { bench.answer(0, tlm::TLM_ADDRESS_ERROR_RESPONSE); }),
               Contains("bench.port") && Contains("0x6c") && Contains("TLM_ADDRESS_ERROR_RESPONSE"));
}

TEST_CASE("memory port: a memory that forgets the response status is an error") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.port.request(bench.addresses, 1);
    CHECK_THAT(error_of([&] { bench.answer(0, tlm::TLM_INCOMPLETE_RESPONSE); }),
               Contains("bench.port") && Contains("TLM_INCOMPLETE_RESPONSE"));
}

namespace {

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
    target.come[0]->set_response_status(tlm::TLM_OK_RESPONSE);
    CHECK(breach(*target.come[0], tlm::BEGIN_RESP).empty());
    CHECK_THAT(breach(*target.come[1], tlm::BEGIN_RESP), Contains("before END_REQ"));
    CHECK(unit.port.answered());
    unit.port.pop_answer();
    CHECK(breach(*target.come[1], tlm::END_REQ).empty());
    target.status = tlm::TLM_COMPLETED;
    CHECK_THAT(error_of([&] { unit.port.read(0); }),
               Contains("unit.port") && Contains("answered by neither"));
}
