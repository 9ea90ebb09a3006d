#include <tlm_utils/simple_target_socket.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "modules/memory/memory_port.h"
#include "modules/memory/table_memory.h"
#include "testbench/tests/memory_protocol.h"
#include "testbench/tests/timed_modules.h"

// The tables' sockets and the ports that read them: base protocol responses, direct access, breaches by either side.

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
    make_read(payload, bench.data, layout.base, static_cast<unsigned>(layout.bytes()) + 1);
    bench.expect(payload, tlm::TLM_ADDRESS_ERROR_RESPONSE);
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

TEST_CASE("table memory: a copied request asks for the same addresses") {
    GatherExtension gather;
    gather.count = 2;
    gather.address = {layout.base + 8, layout.base + 60};
    Transaction payload, copy;
    payload.set_extension(&gather);
    copy.deep_copy_from(payload);
    const auto* copied = copy.get_extension<GatherExtension>();
    REQUIRE(copied != nullptr);
    CHECK(copied != &gather);
    CHECK(copied->count == 2);
    CHECK(copied->address == gather.address);
    gather.address[0] = 0;
    copy.update_extensions_from(payload);
    CHECK(copied->address[0] == 0);
    copy.free_all_extensions();
    payload.clear_extension(&gather);
}

TEST_CASE("table memory: debug access reads and writes what lies in the table, and nothing else") {
    TableBench bench;
    Transaction payload;
    const auto access = [&](tlm::tlm_command command, std::uint64_t address, unsigned length = 4) {
        make_read(payload, bench.data, address, length);
        payload.set_command(command);
        return bench.initiator.socket->transport_dbg(payload);
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

TEST_CASE("table memory: direct access is granted for reads, over the whole table, at its latency") {
    TableBench bench;
    Transaction payload;
    tlm::tlm_dmi dmi;
    make_read(payload, bench.data, layout.base + 8);
    payload.set_command(tlm::TLM_WRITE_COMMAND);
    CHECK_FALSE(bench.initiator.socket->get_direct_mem_ptr(payload, dmi));
    make_read(payload, bench.data, layout.base + layout.bytes());
    CHECK_FALSE(bench.initiator.socket->get_direct_mem_ptr(payload, dmi));
    make_read(payload, bench.data, layout.base + 8);
    REQUIRE(bench.initiator.socket->get_direct_mem_ptr(payload, dmi));
    CHECK(dmi.is_read_allowed());
    CHECK_FALSE(dmi.is_write_allowed());
    CHECK(dmi.get_start_address() == layout.base);
    CHECK(dmi.get_end_address() == layout.base + layout.bytes() - 1);
    CHECK(dmi.get_read_latency() == period);
}

TEST_CASE("table memory: a plain read takes a port of its own address's bank") {
    Clock clock("clock", period);
    MemoryTiming timing;
    timing.banks = 2;
    timing.buffer = 2;
    TableMemory memory("memory", clock, layout, timing, {});
    clock.attach(memory);
    Initiator initiator("initiator");
    initiator.socket.bind(memory.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    Manager manager;
    unsigned char data[8] = {};
    Transaction first(&manager), second(&manager);
    const auto cycles_of = [&](std::uint64_t first_address, std::uint64_t second_address) {
        const std::uint64_t begin = clock.cycle();
        make_read(first, data, first_address);
        make_read(second, data, second_address);
        for (Transaction* it : {&first, &second}) {
            it->acquire();
            CHECK(initiator.send(*it, tlm::BEGIN_REQ) == tlm::TLM_UPDATED);
        }
        sc_core::sc_start();
        return clock.last_cycle() - begin;
    };
    CHECK(cycles_of(layout.base, layout.base + 4) == 1);
    CHECK(cycles_of(layout.base, layout.base + 8) == 2);
    CHECK(initiator.back.size() == 4);
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
    for (const auto& [status, phase] : std::vector<std::pair<tlm::tlm_sync_enum, tlm::tlm_phase>>{
             {tlm::TLM_COMPLETED, tlm::END_REQ}, {tlm::TLM_UPDATED, tlm::BEGIN_RESP}}) {
        bench.target.status = status;
        bench.target.phase_back = phase;
        CHECK_THAT(error_of([&] { bench.port.request(bench.addresses, 1); }),
                   Contains("bench.port") && Contains("answered by neither"));
    }
}

namespace {

/// A blocking memory of four entries whose answers about direct access are the test's.
struct DirectTarget : sc_core::sc_module {
    tlm_utils::simple_target_socket<DirectTarget> socket{"socket"};
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
    void b_transport(Transaction& payload, sc_time& delay) {
        ++transactions;
        std::copy_n(&bytes[payload.get_address()], payload.get_data_length(), payload.get_data_ptr());
        payload.set_dmi_allowed(true);
        payload.set_response_status(tlm::TLM_OK_RESPONSE);
        delay += period;
    }
    bool get_direct_mem_ptr(Transaction&, tlm::tlm_dmi& dmi) {
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

TEST_CASE(
    "memory port: reads are transactions until direct access is granted, and again after it is withdrawn") {
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
    read();  // asks, and is granted
    read();
    read();
    CHECK(target.asked == 4);
    CHECK(target.transactions == 4);
    target.socket->invalidate_direct_mem_ptr(0, 15);
    read();
    CHECK(target.transactions == 5);
    read();
    CHECK(target.transactions == 5);
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
