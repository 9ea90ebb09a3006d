#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "modules/memories/table_memory.h"
#include "modules/sockets/memory_port.h"
#include "testbench/tests/support/memory_protocol.h"
#include "testbench/tests/support/timed_modules.h"

// The tables' sockets and the ports that read them: responses, direct access, violations by either side.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_PS;
using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;
using Cycles = std::vector<std::uint64_t>;

namespace {

const sc_time period(10, SC_PS);
const datapath::TableLayout layout{4096, 16, 16, 4};

struct TableBench {
    CycleScheduler clock{"clock", period};
    TableMemory memory{"memory", clock, layout, MemoryTiming{}, {}};
    Initiator initiator{"initiator"};
    unsigned char data[64] = {};

    TableBench() {
        clock.attach(memory);
        initiator.socket.bind(memory.socket);
        sc_core::sc_start(SC_ZERO_TIME);
    }

    /// Blocking and non-blocking transport must give the same response.
    void expect(MemoryRequest request, tlm::tlm_response_status expected) {
        MemoryRequest timed = request;
        sc_time delay(5, SC_PS);
        initiator.socket->b_transport(request, delay);
        CHECK(request.response == expected);
        CHECK(delay == sc_time(expected == tlm::TLM_OK_RESPONSE ? 15 : 5, SC_PS));

        initiator.back.clear();
        CHECK(initiator.send(timed, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
        sc_core::sc_start();
        REQUIRE(initiator.back.size() == 1);
        CHECK(initiator.back[0].first == tlm::BEGIN_RESP);
        CHECK(timed.response == expected);
    }
};

}  // namespace

TEST_CASE("table memory: every response is the same, blocking and non-blocking") {
    TableBench bench;
    bench.expect(read_of(bench.data, layout.base), tlm::TLM_OK_RESPONSE);
    bench.expect(read_of(bench.data, layout.base + layout.bytes() - 4), tlm::TLM_OK_RESPONSE);
    const std::uint64_t counted = bench.memory.transactions();
    CHECK(counted == 4);

    for (const std::uint64_t outside : {layout.base - 1, layout.base - 4, layout.base + layout.bytes() - 3,
                                        layout.base + layout.bytes(), std::uint64_t{0}, ~std::uint64_t{0} - 2})
        bench.expect(read_of(bench.data, outside), tlm::TLM_ADDRESS_ERROR_RESPONSE);
    bench.expect(read_of(bench.data, layout.base, static_cast<unsigned>(layout.bytes()) + 1),
                 tlm::TLM_ADDRESS_ERROR_RESPONSE);
    for (const tlm::tlm_command command : {tlm::TLM_WRITE_COMMAND, tlm::TLM_IGNORE_COMMAND}) {
        MemoryRequest other = read_of(bench.data, layout.base);
        other.command = command;
        bench.expect(other, tlm::TLM_COMMAND_ERROR_RESPONSE);
    }
    CHECK(bench.memory.transactions() == counted);  // only reads are counted
}

TEST_CASE("table memory: a gather with one address outside is an address error") {
    TableBench bench;
    MemoryRequest gather = read_of(bench.data, layout.base);
    gather.count = 4;
    gather.address = {layout.base, layout.base + 4, layout.base + layout.bytes(), layout.base + 8};
    bench.expect(gather, tlm::TLM_ADDRESS_ERROR_RESPONSE);
    gather.address[2] = layout.base + layout.bytes() - 4;
    bench.expect(gather, tlm::TLM_OK_RESPONSE);
    CHECK(bench.memory.transactions() == 2 * 4);
}

TEST_CASE("table memory: debug access reads and writes the table, and nothing else") {
    TableBench bench;
    const auto access = [&](tlm::tlm_command command, std::uint64_t address) {
        MemoryRequest request = read_of(bench.data, address);
        request.command = command;
        return bench.initiator.socket->transport_dbg(request);
    };
    const std::vector<unsigned char> written{1, 2, 3, 4};
    std::copy(written.begin(), written.end(), bench.data);
    CHECK(access(tlm::TLM_WRITE_COMMAND, layout.base + 8) == 4);
    std::fill_n(bench.data, 4, static_cast<unsigned char>(9));
    CHECK(access(tlm::TLM_IGNORE_COMMAND, layout.base + 8) == 0);
    CHECK(bench.data[0] == 9);
    CHECK(access(tlm::TLM_READ_COMMAND, layout.base + 8) == 4);
    CHECK(std::equal(written.begin(), written.end(), bench.data));
    for (const tlm::tlm_command command : {tlm::TLM_READ_COMMAND, tlm::TLM_WRITE_COMMAND}) {
        CHECK(access(command, layout.base - 1) == 0);
        CHECK(access(command, layout.base + layout.bytes() - 3) == 0);
    }
    CHECK(bench.memory.transactions() == 0);
    CHECK(sc_core::sc_time_stamp() == SC_ZERO_TIME);
}

TEST_CASE("table memory: the host loads it through the base protocol's debug transport, any number of bytes") {
    CycleScheduler clock("clock", period);
    TableMemory memory("memory", clock, layout, MemoryTiming{}, {});
    struct Host : sc_core::sc_module {
        tlm_utils::simple_initiator_socket<Host> socket{"socket"};
        explicit Host(const sc_core::sc_module_name& name) : sc_module(name) {}
        unsigned access(tlm::tlm_command command, std::uint64_t address, std::vector<unsigned char>& bytes) {
            tlm::tlm_generic_payload payload;
            payload.set_command(command);
            payload.set_address(address);
            payload.set_data_ptr(bytes.data());
            payload.set_data_length(static_cast<unsigned>(bytes.size()));
            return socket->transport_dbg(payload);
        }
    } host("host");
    host.socket.bind(memory.host);
    sc_core::sc_start(SC_ZERO_TIME);
    std::vector<unsigned char> row{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    CHECK(host.access(tlm::TLM_WRITE_COMMAND, layout.base + layout.bytes() - 12, row) == 12);
    CHECK(host.access(tlm::TLM_WRITE_COMMAND, layout.base + layout.bytes() - 11, row) == 0);
    std::vector<unsigned char> read(5);
    CHECK(host.access(tlm::TLM_READ_COMMAND, layout.base + layout.bytes() - 9, read) == 5);
    CHECK(read == std::vector<unsigned char>{4, 5, 6, 7, 8});
}

TEST_CASE("table memory: direct access is granted for reads, over the whole table, at its latency") {
    TableBench bench;
    tlm::tlm_dmi dmi;
    MemoryRequest request = read_of(bench.data, layout.base + 8);
    request.command = tlm::TLM_WRITE_COMMAND;
    CHECK_FALSE(bench.initiator.socket->get_direct_mem_ptr(request, dmi));
    request = read_of(bench.data, layout.base + layout.bytes());
    CHECK_FALSE(bench.initiator.socket->get_direct_mem_ptr(request, dmi));
    request = read_of(bench.data, layout.base + 8);
    REQUIRE(bench.initiator.socket->get_direct_mem_ptr(request, dmi));
    CHECK(dmi.is_read_allowed());
    CHECK_FALSE(dmi.is_write_allowed());
    CHECK(dmi.get_start_address() == layout.base);
    CHECK(dmi.get_end_address() == layout.base + layout.bytes() - 1);
    CHECK(dmi.get_read_latency() == period);
}

TEST_CASE("table memory: a plain read uses a port of its address's bank") {
    CycleScheduler clock("clock", period);
    MemoryTiming timing;
    timing.banks = 2;
    timing.buffer = 2;
    TableMemory memory("memory", clock, layout, timing, {});
    clock.attach(memory);
    Initiator initiator("initiator");
    initiator.socket.bind(memory.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    unsigned char data[8] = {};
    MemoryRequest first, second;
    const auto cycles_of = [&](std::uint64_t first_address, std::uint64_t second_address) {
        const std::uint64_t begin = clock.cycle();
        first = read_of(data, first_address);
        second = read_of(data, second_address);
        CHECK(initiator.send(first, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
        CHECK(initiator.send(second, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
        sc_core::sc_start();
        return clock.last_cycle() - begin;
    };
    CHECK(cycles_of(layout.base, layout.base + 4) == 1);
    CHECK(cycles_of(layout.base, layout.base + 8) == 2);
    CHECK(initiator.back.size() == 4);
}

TEST_CASE("table memory: the delay of a request is added before it is served") {
    TableBench bench;
    MemoryRequest request = read_of(bench.data, layout.base);
    // 25 ps later, in cycle 3; answered after a latency of 1
    CHECK(bench.initiator.send(request, tlm::BEGIN_REQ, sc_time(25, SC_PS)) == tlm::TLM_ACCEPTED);
    sc_core::sc_start(sc_time(29, SC_PS));
    CHECK(bench.initiator.back.empty());
    sc_core::sc_start(sc_time(2, SC_PS));
    REQUIRE(bench.initiator.back.size() == 1);
    CHECK(bench.initiator.back[0].first == tlm::END_REQ);
    sc_core::sc_start();
    REQUIRE(bench.initiator.back.size() == 2);
    CHECK(bench.clock.last_cycle() == 4);
}

TEST_CASE("table memory: an initiator's protocol violations are errors that name the memory's socket") {
    TableBench bench;
    MemoryRequest first = read_of(bench.data, layout.base);
    MemoryRequest second = first;
    MemoryRequest third = first;
    for (const tlm::tlm_phase& phase :
         {tlm::tlm_phase(tlm::END_REQ), tlm::tlm_phase(tlm::BEGIN_RESP), tlm::tlm_phase(tlm::END_RESP)})
        CHECK_THAT(error_of([&] { bench.initiator.send(first, phase); }),
                   Contains("memory.socket") && Contains("other than BEGIN_REQ"));
    CHECK(bench.initiator.send(first, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);    // in the buffer
    CHECK(bench.initiator.send(second, tlm::BEGIN_REQ) == tlm::TLM_ACCEPTED);  // has to wait
    CHECK_THAT(error_of([&] { bench.initiator.send(third, tlm::BEGIN_REQ); }),
               Contains("memory.socket") && Contains("BEGIN_REQ before END_REQ"));
    bench.initiator.reply = tlm::TLM_ACCEPTED;  // would end the response itself, later
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains("memory.socket") && Contains("BEGIN_RESP was not completed"));
}

namespace {

/// A MemoryPort for three requests, connected to a target that the test controls.
struct PortBench : sc_core::sc_module {
    CycleScheduler clock{"clock", period};
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
        target.come[k]->response = response;
        target.send_back(*target.come[k], tlm::BEGIN_RESP);
    }
};

}  // namespace

TEST_CASE("memory port: one request on offer, several in flight, answers in order") {
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
    CHECK(bench.target.come[1]->bytes() == 16);
    CHECK(bench.target.come[2]->address[0] == 108);
    CHECK_FALSE(bench.port.answered());
    bench.answer(0);
    CHECK(bench.port.answered());
    bench.port.pop_answer();
    CHECK_FALSE(bench.port.answered());
    CHECK_FALSE(bench.port.may_request());  // one is still offered
    bench.target.send_back(*bench.target.come[2], tlm::END_REQ);
    CHECK(bench.port.may_request());
    bench.answer(1);
    bench.answer(2);
    bench.port.pop_answer();
    bench.port.pop_answer();
    CHECK(bench.port.requests_under_way() == 0);
    CHECK(bench.port.reads() == 6);
}

TEST_CASE("memory port: the delay of an answer is added before the owner is called") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.port.request(bench.addresses, 1);
    bench.target.come[0]->response = tlm::TLM_OK_RESPONSE;
    bench.target.send_back(*bench.target.come[0], tlm::BEGIN_RESP, sc_time(31, SC_PS));
    sc_core::sc_start();
    CHECK(bench.called == Cycles{4});
}

TEST_CASE("memory port: a memory's protocol violations are errors that name the port") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    Target& target = bench.target;
    MemoryRequest stranger;
    const auto breach = [&](MemoryRequest& request, tlm::tlm_phase phase) {
        return error_of([&] { target.send_back(request, phase); });
    };
    CHECK_THAT(breach(stranger, tlm::BEGIN_RESP), Contains("bench.port") && Contains("unknown request"));
    CHECK_THAT(breach(stranger, tlm::END_REQ), Contains("bench.port") && Contains("not pending"));
    bench.port.request(bench.addresses, 1);
    bench.port.request(bench.addresses + 1, 1);
    CHECK_THAT(breach(*target.come[0], tlm::END_REQ), Contains("not pending"));  // it was ended by return
    CHECK_THAT(breach(*target.come[1], tlm::BEGIN_RESP), Contains("bench.port") && Contains("out of order"));
    for (const tlm::tlm_phase& phase : {tlm::tlm_phase(tlm::BEGIN_REQ), tlm::tlm_phase(tlm::END_RESP)})
        CHECK_THAT(breach(*target.come[0], phase), Contains("bench.port") && Contains("a memory must not send"));
    bench.answer(0);
    bench.answer(1);
    target.status = tlm::TLM_ACCEPTED;
    bench.port.request(bench.addresses + 2, 1);
    CHECK_THAT(breach(*target.come[2], tlm::BEGIN_RESP), Contains("before END_REQ"));
    CHECK_THAT(breach(stranger, tlm::END_REQ), Contains("not pending"));
    CHECK_THAT(error_of([&] { bench.port.request(bench.addresses, 1); }),
               Contains("bench.port") && Contains("BEGIN_REQ before END_REQ"));
}

TEST_CASE("memory port: END_REQ both on the backward path and by return is an error") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.target.on_request = [&](MemoryRequest& request) { bench.target.send_back(request, tlm::END_REQ); };
    CHECK_THAT(error_of([&] { bench.port.request(bench.addresses, 1); }),
               Contains("bench.port") && Contains("END_REQ returned"));
    bench.target.status = tlm::TLM_ACCEPTED;
    bench.port.request(bench.addresses, 1);
    CHECK_FALSE(bench.port.on_offer());
}

TEST_CASE("memory port: an invalid answer by return is an error") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    for (const auto& [status, phase] : std::vector<std::pair<tlm::tlm_sync_enum, tlm::tlm_phase>>{
             {tlm::TLM_COMPLETED, tlm::END_REQ}, {tlm::TLM_UPDATED, tlm::BEGIN_RESP}}) {
        bench.target.status = status;
        bench.target.phase_back = phase;
        CHECK_THAT(error_of([&] { bench.port.request(bench.addresses, 1); }),
                   Contains("bench.port") && Contains("answered by neither"));
    }
}

namespace {

/// A blocking memory of four entries whose responses about direct access are set by the test.
struct DirectTarget : sc_core::sc_module {
    tlm_utils::passthrough_target_socket<DirectTarget, 32, MemoryProtocol> socket{"socket"};
    std::vector<unsigned char> bytes = std::vector<unsigned char>(16);
    bool grants = true;
    bool readable = true;
    std::uint64_t last = 15;
    unsigned transactions = 0;
    unsigned asked = 0;

    explicit DirectTarget(const sc_core::sc_module_name& name) : sc_module(name) {
        for (std::size_t k = 0; k < bytes.size(); ++k)
            bytes[k] = static_cast<unsigned char>(k);
        socket.register_b_transport(this, &DirectTarget::b_transport);
        socket.register_get_direct_mem_ptr(this, &DirectTarget::get_direct_mem_ptr);
    }

  private:
    void b_transport(MemoryRequest& request, sc_time& delay) {
        ++transactions;
        std::copy_n(&bytes[request.address[0]], request.bytes(), request.data);
        request.dmi_allowed = true;
        request.response = tlm::TLM_OK_RESPONSE;
        delay += period;
    }
    bool get_direct_mem_ptr(MemoryRequest&, tlm::tlm_dmi& dmi) {
        ++asked;
        dmi.set_dmi_ptr(bytes.data());
        dmi.set_start_address(0);
        dmi.set_end_address(last);
        dmi.set_read_latency(period);
        if (readable)
            dmi.allow_read();
        else
            dmi.allow_write();
        return grants;
    }
};

}  // namespace

TEST_CASE("memory port: reads are transactions until direct access is granted, and again after it is withdrawn") {
    DirectTarget target("target");
    struct Owner : sc_core::sc_module {
        MemoryPort port{"port", 4, true};
        explicit Owner(const sc_core::sc_module_name& name) : sc_module(name) {}
    } owner("owner");
    owner.port.socket.bind(target.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    sc_time delay = SC_ZERO_TIME;
    unsigned reads = 0;
    const auto read = [&] {
        CHECK(owner.port.read(4, delay) == 0x07060504);
        CHECK(owner.port.reads() == ++reads);
        CHECK(delay == period * reads);
    };
    target.grants = false;
    read();
    target.grants = true;
    target.readable = false;
    read();
    target.readable = true;
    target.last = 6;  // entries are fetched eight bytes at a time
    read();
    CHECK(target.asked == 3);
    CHECK(target.transactions == 3);
    target.last = 15;
    read();  // requests it, and it is granted
    read();
    read();
    CHECK(target.asked == 4);
    CHECK(target.transactions == 4);
    target.socket->invalidate_direct_mem_ptr(0, 15);
    read();
    CHECK(target.transactions == 5);
    read();
    CHECK(target.transactions == 5);
    const auto read_two = [&](std::uint64_t second) {
        const std::array<std::uint64_t, 2> addresses{4, second};
        std::array<std::uint64_t, 2> entries{};
        owner.port.read(addresses.data(), 2, entries.data(), delay);
        CHECK(owner.port.reads() == (reads += 2));
        CHECK(delay == period * reads);
        return entries;
    };
    CHECK(read_two(8) == std::array<std::uint64_t, 2>{0x07060504, 0x0b0a0908});
    CHECK(target.transactions == 5);
    CHECK(read_two(12) == std::array<std::uint64_t, 2>{0x07060504, 0x0f0e0d0c});  // the last entry
    CHECK(target.transactions == 7);
}

TEST_CASE("memory port: an error response is an error that names port, address and response") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.port.request(bench.addresses + 2, 1);
    CHECK_THAT(error_of([&] { bench.answer(0, tlm::TLM_ADDRESS_ERROR_RESPONSE); }),
               Contains("bench.port") && Contains("0x6c") && Contains("TLM_ADDRESS_ERROR_RESPONSE"));
}

TEST_CASE("memory port: a response without a status is an error") {
    PortBench bench("bench");
    sc_core::sc_start(SC_ZERO_TIME);
    bench.port.request(bench.addresses, 1);
    CHECK_THAT(error_of([&] { bench.answer(0, tlm::TLM_INCOMPLETE_RESPONSE); }),
               Contains("bench.port") && Contains("TLM_INCOMPLETE_RESPONSE"));
}
