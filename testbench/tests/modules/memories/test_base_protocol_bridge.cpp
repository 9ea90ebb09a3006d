#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "modules/memories/base_protocol_bridge.h"
#include "testbench/tests/modules/memories/base_protocol_memories.h"
#include "testbench/tests/modules/memories/memory_reader.h"
#include "testbench/tests/support/case_table.h"

// Memories of the base protocol, which do not support gathers, behind the bridge: the rules of the protocol, one by
// one.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::SC_PS;
using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;
using Cycles = std::vector<std::uint64_t>;
using Payload = tlm::tlm_generic_payload;

namespace {

const sc_time period(10, SC_PS);

std::uint64_t own_address(std::uint64_t address) {
    return (address & 255) | ((address + 1) & 255) << 8 | ((address + 2) & 255) << 16 | ((address + 3) & 255) << 24;
}

/// A reader and a bridge in front of a memory of the base protocol.
struct Bench {
    CycleScheduler clock;
    BaseProtocolBridge bridge;
    MemoryReader reader;

    explicit Bench(unsigned buffer = 1, const std::string& prefix = "")
        : clock((prefix + "clock").c_str(), period),
          bridge((prefix + "bridge").c_str(), clock, buffer),
          reader((prefix + "reader").c_str(), clock, 8, true) {
        reader.port.bind(bridge);
    }

    void run() {
        sc_core::sc_start();
        std::vector<std::uint64_t> expected;
        for (const auto& addresses : reader.reads)
            for (const std::uint32_t address : addresses)
                expected.push_back(own_address(address));
        CHECK(reader.values == expected);
        CHECK(bridge.describe_contents().empty());
        CHECK(bridge.activity().items_in() == bridge.activity().items_out());
    }
};

std::vector<std::vector<std::uint32_t>> gathers(unsigned count, unsigned entries) {
    std::vector<std::vector<std::uint32_t>> reads(count);
    for (unsigned k = 0; k < count; ++k)
        for (unsigned entry = 0; entry < entries; ++entry)
            reads[k].push_back(68 * k + 20 * (entry + 1));
    return reads;
}

struct Row {
    std::string name;
    unsigned latency;  ///< picoseconds
    std::vector<std::vector<std::uint32_t>> reads;
    Cycles answered;
};

// As in test_table_memory.cpp for a table with one port: entries are sent in cycles 10, 11, 12 ...
const CaseTable blocking(
    "bridge: ",
    {
        Row{"a blocking memory of one cycle behaves as a table of one port and latency 1",
            10,
            gathers(5, 4),
            {14, 18, 22, 26, 30}},
        {"a part of a cycle counts as a cycle", 7, gathers(5, 4), {14, 18, 22, 26, 30}},
        // entries in 10, 13, 16 ...
        {"no entry is sent before the END_REQ that an answer implies", 30, gathers(3, 2), {16, 22, 28}},
    },
    [](const Row& row) {
        Bench bench;
        BlockingMemory memory("memory", sc_time(row.latency, SC_PS));
        bench.bridge.to_memory.bind(memory.socket);
        bench.reader.reads = row.reads;
        bench.run();
        CHECK(bench.reader.answered == row.answered);
        CHECK(bench.bridge.occupied_cycles() == memory.accesses);
    });

}  // namespace

TEST_CASE("bridge: requests wait in its buffer while entries are sent") {
    Bench bench(2);
    BlockingMemory memory("memory", period);
    bench.bridge.to_memory.bind(memory.socket);
    bench.reader.reads = gathers(6, 4);
    bench.run();
    CHECK(bench.reader.offered == Cycles{10, 10, 10, 10, 14, 18});  // one sent, two waiting, one offered
}

namespace {

/// Non-blocking transport in a way that the test selects.
struct ScriptedMemory : sc_core::sc_module {
    enum class Way { completed, begin_response, end_request, accepted, begin_request };

    tlm_utils::passthrough_target_socket<ScriptedMemory> socket{"socket"};
    Bytes bytes;
    Way way = Way::completed;
    sc_time delay = SC_ZERO_TIME;
    std::vector<Payload*> come;
    std::size_t responses_ended = 0;
    std::function<void(Payload&)> on_request = [](Payload&) {};

    explicit ScriptedMemory(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_nb_transport_fw(this, &ScriptedMemory::nb_transport_fw);
    }
    tlm::tlm_sync_enum send_back(Payload& payload, tlm::tlm_phase phase, sc_time its_delay = SC_ZERO_TIME) {
        return socket->nb_transport_bw(payload, phase, its_delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_fw(Payload& payload, tlm::tlm_phase& phase, sc_time& its_delay) {
        if (phase == tlm::END_RESP) {
            ++responses_ended;
            return tlm::TLM_COMPLETED;
        }
        CHECK(payload.get_ref_count() == 1);
        come.push_back(&payload);
        bytes.access(payload);
        on_request(payload);
        its_delay += delay;
        switch (way) {
            case Way::completed: return tlm::TLM_COMPLETED;
            case Way::begin_response: phase = tlm::BEGIN_RESP; return tlm::TLM_UPDATED;
            case Way::end_request: phase = tlm::END_REQ; return tlm::TLM_UPDATED;
            case Way::begin_request:  // a violation
                return tlm::TLM_UPDATED;
            default: return tlm::TLM_ACCEPTED;
        }
    }
};

/// A scripted memory, and its actions by cycle.
struct ScriptedBench : Bench {
    ScriptedMemory memory{"memory"};
    Caller script{clock};
    std::map<std::uint64_t, std::function<void()>> acts;

    explicit ScriptedBench(ScriptedMemory::Way way, unsigned buffer = 1) : Bench(buffer) {
        bridge.to_memory.bind(memory.socket);
        memory.way = way;
        script.on_step = [this] {
            const auto act = acts.find(clock.cycle());
            if (act != acts.end())
                act->second();
        };
    }
    void in_cycle(std::uint64_t cycle, std::function<void()> act) {
        acts[cycle] = std::move(act);
        clock.wake_at(script, cycle);
    }
    void answer(std::size_t k, const sc_time& delay = SC_ZERO_TIME) {
        CHECK(memory.send_back(*memory.come[k], tlm::BEGIN_RESP, delay) == tlm::TLM_COMPLETED);
    }
};

using Way = ScriptedMemory::Way;

}  // namespace

TEST_CASE("bridge: a memory that completes at once answers in the cycle of the last entry") {
    ScriptedBench bench(Way::completed);
    bench.reader.reads = gathers(3, 2);
    bench.run();
    CHECK(bench.reader.answered == Cycles{11, 13, 15});
    CHECK(bench.memory.responses_ended == 0);
}

TEST_CASE("bridge: a memory that completes with a delay accepts and answers at its end") {
    ScriptedBench bench(Way::completed);
    bench.memory.delay = sc_time(25, SC_PS);  // three cycles
    bench.reader.reads = gathers(3, 2);
    bench.run();
    CHECK(bench.reader.answered == Cycles{16, 22, 28});
}

TEST_CASE("bridge: an answer by return is ended exactly once") {
    ScriptedBench bench(Way::begin_response);
    bench.memory.delay = period;
    bench.reader.reads = gathers(3, 2);
    bench.run();
    CHECK(bench.reader.answered == Cycles{12, 14, 16});
    CHECK(bench.memory.responses_ended == 6);
}

TEST_CASE("bridge: END_REQ by return with a delay: the next entry is sent after the delay") {
    ScriptedBench bench(Way::end_request);
    bench.memory.delay = sc_time(20, SC_PS);
    bench.reader.reads = gathers(1, 3);
    Cycles seen;
    for (std::uint64_t cycle = 10; cycle < 20; ++cycle)
        bench.in_cycle(cycle, [&] { seen.push_back(bench.memory.come.size()); });
    bench.in_cycle(30, [&] {
        for (std::size_t k = 0; k < 3; ++k)
            bench.answer(k);
    });
    bench.run();
    // the script is called after the bridge
    CHECK(seen == Cycles{1, 1, 2, 2, 3, 3, 3, 3, 3, 3});
    CHECK(bench.reader.answered == Cycles{30});
}

TEST_CASE("bridge: an answer does not end another entry's request") {
    ScriptedBench bench(Way::accepted);
    bench.reader.reads = gathers(1, 3);
    bench.in_cycle(12, [&] { bench.memory.send_back(*bench.memory.come[0], tlm::END_REQ); });
    bench.in_cycle(15, [&] {
        CHECK(bench.memory.come.size() == 2);
        bench.answer(0);
    });
    bench.in_cycle(20, [&] {
        CHECK(bench.memory.come.size() == 2);
        bench.answer(1);
    });
    bench.in_cycle(25, [&] { bench.answer(2); });
    bench.run();
    CHECK(bench.reader.answered == Cycles{25});
}

TEST_CASE("bridge: END_REQ may come later, and its delay is added") {
    ScriptedBench bench(Way::accepted);
    bench.reader.reads = gathers(1, 2);
    bench.in_cycle(15, [&] {
        CHECK(bench.memory.come.size() == 1);
        CHECK(bench.memory.send_back(*bench.memory.come[0], tlm::END_REQ, sc_time(20, SC_PS)) == tlm::TLM_ACCEPTED);
    });
    bench.in_cycle(16, [&] { CHECK(bench.memory.come.size() == 1); });
    bench.in_cycle(17, [&] { CHECK(bench.memory.come.size() == 2); });
    bench.in_cycle(20, [&] { bench.answer(1, sc_time(35, SC_PS)); });  // implies END_REQ; the response is in 24
    bench.in_cycle(21, [&] { bench.answer(0, sc_time(15, SC_PS)); });  // in 23
    bench.run();
    CHECK(bench.reader.answered == Cycles{24});
}

TEST_CASE("bridge: answers may come in any order, the reader gets them in the order of its requests") {
    ScriptedBench bench(Way::end_request, 4);
    bench.reader.reads = gathers(3, 2);  // entries 0 to 5, sent in 10 to 15
    const std::vector<std::size_t> order{5, 1, 2, 4, 0, 3};
    for (std::size_t k = 0; k < order.size(); ++k)
        bench.in_cycle(20 + 10 * k, [&, k] { bench.answer(order[k]); });
    bench.run();
    // request 2 is complete in 50 (5, 4), 0 in 60 (1, 0), 1 in 70 (2, 3)
    CHECK(bench.reader.answered == Cycles{60, 70, 70});
}

TEST_CASE("bridge: a payload that the memory keeps is not reused until it is released") {
    ScriptedBench bench(Way::end_request);
    bench.reader.reads = gathers(4, 1);
    bench.in_cycle(20, [&] {
        bench.memory.come[0]->acquire();
        bench.answer(0);
    });
    bench.in_cycle(21, [&] { bench.answer(1); });
    bench.in_cycle(22, [&] {
        for (std::size_t k = 2; k < bench.memory.come.size(); ++k)
            bench.answer(k);
    });
    bench.run();
    REQUIRE(bench.memory.come.size() == 4);
    for (std::size_t k = 1; k < 4; ++k)
        CHECK(bench.memory.come[k] != bench.memory.come[0]);
    CHECK(bench.memory.come[0]->get_ref_count() == 1);
    bench.memory.come[0]->release();
    for (const Payload* payload : bench.memory.come)
        CHECK(payload->get_ref_count() == 0);
}

TEST_CASE("bridge: one failed entry fails its request, and the port reports the response") {
    ScriptedBench bench(Way::end_request);
    bench.reader.reads = gathers(1, 3);
    bench.in_cycle(20, [&] {
        bench.memory.come[1]->set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
        for (std::size_t k = 0; k < 3; ++k)
            bench.answer(k);
    });
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains("reader.port") && Contains("TLM_ADDRESS_ERROR_RESPONSE"));
}

TEST_CASE("bridge: a memory may answer before the request's call returns") {
    ScriptedBench bench(Way::accepted);
    bench.memory.on_request = [&](Payload& payload) { bench.memory.send_back(payload, tlm::BEGIN_RESP); };
    bench.reader.reads = gathers(3, 2);
    bench.run();
    CHECK(bench.reader.answered == Cycles{11, 13, 15});
}

TEST_CASE("bridge: an answer before the call returns and another by return are an error") {
    ScriptedBench bench(Way::completed);
    bench.memory.on_request = [&](Payload& payload) { bench.memory.send_back(payload, tlm::BEGIN_RESP); };
    bench.reader.reads = gathers(1, 2);
    CHECK_THAT(error_of([] { sc_core::sc_start(); }), Contains("bridge.to_memory") && Contains("answered twice"));
}

TEST_CASE("bridge: an invalid answer by return is an error") {
    ScriptedBench bench(Way::begin_request);
    bench.reader.reads = gathers(1, 1);
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains("bridge.to_memory") && Contains("neither END_REQ nor BEGIN_RESP"));
}

namespace {
TLM_DECLARE_EXTENDED_PHASE(of_its_own);
}

TEST_CASE("bridge: a memory's protocol violations are errors that name the bridge's socket, other phases are ignored") {
    ScriptedBench bench(Way::end_request);
    bench.reader.reads = gathers(1, 2);
    Payload stranger;
    bench.in_cycle(20, [&] {
        const auto breach = [&](Payload& payload, const tlm::tlm_phase& phase) {
            return error_of([&] { bench.memory.send_back(payload, phase); });
        };
        Payload& first = *bench.memory.come[0];
        CHECK_THAT(breach(first, tlm::END_REQ), Contains("bridge.to_memory") && Contains("not pending"));
        CHECK_THAT(breach(stranger, tlm::BEGIN_RESP), Contains("bridge.to_memory") && Contains("unknown request"));
        CHECK(breach(first, of_its_own).empty());
        bench.answer(0);
        CHECK_THAT(breach(first, tlm::BEGIN_RESP), Contains("unknown request"));
        bench.answer(1);
    });
    bench.run();
}

TEST_CASE("bridge: writes and reads of records") {
    CycleScheduler clock("clock", period);
    BaseProtocolBridge bridge("bridge", clock, 4);
    BlockingMemory memory("memory", sc_time(30, SC_PS));
    bridge.to_memory.bind(memory.socket);
    struct Owner : sc_core::sc_module {
        MemoryPort port{"port", 40, false};
        explicit Owner(const sc_core::sc_module_name& name) : sc_module(name) {}
    } owner("owner");
    owner.port.bind(bridge);
    Caller caller(clock);
    owner.port.clocked_by(clock, caller, 8, 1);
    Cycles answered;
    std::vector<unsigned> read;
    caller.on_step = [&] {
        if (clock.cycle() == 10) {
            std::fill_n(owner.port.entry_to_write(), 40, static_cast<unsigned char>(77));
            owner.port.write(1000);
            owner.port.request(1000);
            owner.port.request(1020);
        }
        for (; owner.port.answered(); owner.port.pop_answer()) {
            answered.push_back(clock.cycle());
            if (owner.port.answer_is_read())
                read.insert(read.end(), {owner.port.answer()[0], owner.port.answer()[20]});
        }
    };
    clock.wake_at(caller, 10);
    sc_core::sc_start();
    CHECK(answered == Cycles{13, 16, 19});
    CHECK(read == std::vector<unsigned>{77, 77, 77, 1040 & 255});
    CHECK(memory.accesses == 3);
}

namespace {

/// Blocking transport with direct access to 256 bytes.
struct DirectMemory : sc_core::sc_module {
    tlm_utils::simple_target_socket<DirectMemory> socket{"socket"};
    std::vector<unsigned char> bytes;
    unsigned accesses = 0;
    tlm::tlm_response_status response = tlm::TLM_OK_RESPONSE;

    explicit DirectMemory(const sc_core::sc_module_name& name) : sc_module(name) {
        for (unsigned k = 0; k < 256; ++k)
            bytes.push_back(static_cast<unsigned char>(k));
        socket.register_b_transport(this, &DirectMemory::b_transport);
        socket.register_get_direct_mem_ptr(this, &DirectMemory::get_direct_mem_ptr);
    }

  private:
    void b_transport(Payload& payload, sc_time& delay) {
        ++accesses;
        std::copy_n(&bytes[payload.get_address()], payload.get_data_length(), payload.get_data_ptr());
        payload.set_response_status(response);
        payload.set_dmi_allowed(true);
        delay += period;
    }
    bool get_direct_mem_ptr(Payload&, tlm::tlm_dmi& dmi) {
        dmi.set_dmi_ptr(bytes.data());
        dmi.set_start_address(0);
        dmi.set_end_address(255);
        dmi.set_read_latency(period);
        dmi.allow_read();
        return true;
    }
};

}  // namespace

TEST_CASE("bridge: debug transport is forwarded, all bytes or none") {
    Bench bench;
    BlockingMemory memory("memory", period);
    bench.bridge.to_memory.bind(memory.socket);
    Bench other(1, "other");
    DirectMemory without("without");
    other.bridge.to_memory.bind(without.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    std::array<unsigned char, 8> data{};
    MemoryRequest look{tlm::TLM_READ_COMMAND, 2, 4, {40, 80}, data.data()};
    CHECK(bench.reader.port.socket->transport_dbg(look) == 8);
    CHECK(data == std::array<unsigned char, 8>{40, 41, 42, 43, 80, 81, 82, 83});
    CHECK(other.reader.port.socket->transport_dbg(look) == 0);
}

TEST_CASE("bridge: functional mode reads entry by entry, then by direct access until it is withdrawn") {
    Bench bench;
    DirectMemory memory("memory");
    bench.bridge.to_memory.bind(memory.socket);
    sc_core::sc_start(SC_ZERO_TIME);
    sc_time delay = SC_ZERO_TIME;
    unsigned reads = 0;
    const auto read = [&] {
        CHECK(bench.reader.port.read(4, delay) == own_address(4));
        CHECK(delay == period * ++reads);
    };
    read();
    CHECK(memory.accesses == 1);
    read();
    CHECK(memory.accesses == 1);  // direct
    memory.socket->invalidate_direct_mem_ptr(0, 255);
    memory.response = tlm::TLM_GENERIC_ERROR_RESPONSE;
    CHECK_THAT(error_of([&] { bench.reader.port.read(4, delay); }),
               Contains("reader.port") && Contains("TLM_GENERIC_ERROR_RESPONSE"));
    CHECK(memory.accesses == 2);
}

TEST_CASE("bridge: a pipelined memory behaves as a table of the same latency") {
    Bench bench;
    PipelinedMemory memory("memory", period, 20);
    bench.bridge.to_memory.bind(memory.socket);
    bench.reader.reads = gathers(5, 4);
    bench.run();
    CHECK(bench.reader.answered == Cycles{33, 37, 41, 45, 49});  // last entries in 13, 17, 21 ...
}
