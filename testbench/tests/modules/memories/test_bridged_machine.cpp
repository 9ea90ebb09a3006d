#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "modules/datapath/pack_triangle.h"
#include "testbench/tests/modules/memories/base_protocol_memories.h"
#include "testbench/tests/modules/memories/bridged_units.h"
#include "testbench/tests/modules/named_machine.h"
#include "testbench/tests/support/bare_mesh.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_results.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"
#include "testbench/tests/support/timed_modules.h"

// The machine with memories of the base protocol in place of its own: the same mesh, and the same cycles if the
// latencies are equal.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// The machine with such memories, which the host fills.
struct BridgedMachine {
    BridgedUnits units;
    Machine machine;
    Host host;
    Rasteriser rasteriser;
    MeshMonitor monitor;

    BridgedMachine(const MachineSetup& setup, BridgedMemory make)
        : units(setup.design.timing, std::move(make)),
          machine("bridged", setup.registers, setup.design, &units),
          host("bridged_host", machine, setup.base_triangles, tables_of(setup)),
          rasteriser("bridged_rasteriser", machine.clock, setup.design.timing.stalls),
          monitor("bridged_monitor", setup.registers.back_face_culling, 1'000'000) {
        host.bind();
        machine.lighting.to_rasteriser.bind(rasteriser.from_lighting);
        machine.pass_or_tessellate.finished.bind(monitor);
    }
    std::uint64_t cycles() const { return machine.clock.last_cycle() + 1; }
    void require_drained() const {
        CHECK(machine.idle());
        CHECK(machine.height_table.transactions() == 0);
        CHECK(machine.displacement_map.transactions() == 0);
        CHECK(machine.off_chip_memory.bytes_written() == 0);
    }
};

std::unique_ptr<sc_core::sc_module> blocking_5_ns(BaseProtocolBridge& bridge, const std::string& name) {
    return bound<BlockingMemory>(bridge, name, sc_core::sc_time(5, sc_core::SC_NS));
}

/// Runs both machines, requires equal cycles. The bridged memories have the latencies of the machine's own.
void expect_same_cycles(const Job& job) {
    const MachineSetup setup = setup_of(job);
    const Timing& timing = setup.design.timing;
    Simulation simulation(setup, 1'000'000, 0);
    BridgedMachine bridged(setup, [&](BaseProtocolBridge& bridge, const std::string& name) {
        const sc_core::sc_time cycle(timing.cycle_picoseconds, sc_core::SC_PS);
        if (name == "off_chip_memory")
            return bound<PipelinedMemory>(bridge, name, cycle, timing.off_chip_memory.latency,
                                          timing.off_chip_memory.bandwidth,
                                          unsigned{datapath::packed_triangle_tag_bytes});
        return bound<PipelinedMemory>(bridge, name, cycle, timing.summed_height_table.latency);
    });
    CHECK(simulation.run().empty());
    bridged.require_drained();
    CHECK(bridged.cycles() == simulation.cycles());
    CHECK(bridged.machine.triangle_queue.spilled() == simulation.machine.triangle_queue.spilled());
    expect_mesh(bridged.monitor.mesh, simulation.monitor.mesh);
    expect_mesh(bridged.monitor.mesh, bare_mesh(setup));
}

}  // namespace

TEST_CASE("bridged machine: blocking memories of 5 ns, the same mesh and the same cycles") {
    const MachineSetup setup = setup_of(timed_job());
    BridgedMachine machine(setup, blocking_5_ns);
    sc_core::sc_start();
    machine.require_drained();
    CHECK(machine.cycles() == result_of("half_donut").cycles);
    CHECK(machine.monitor.mesh.triangles.size() == result_of("half_donut").triangles);
    expect_mesh(machine.monitor.mesh, bare_mesh(setup));
}

TEST_CASE("bridged machine: functional mode, the same mesh") {
    const MachineSetup setup = setup_of(with_settings({}, "mode=functional"));
    BridgedMachine machine(setup, blocking_5_ns);
    sc_core::sc_start();
    machine.require_drained();
    expect_mesh(machine.monitor.mesh, bare_mesh(setup));
}

// The passes of host and queue then overtake one another.
TEST_CASE("bridged machine: functional mode, memories that wait, and a watermark above 1: the same mesh") {
    const MachineSetup setup = setup_of(with_settings({}, "mode=functional hardware.queue_watermark=8"));
    BridgedMachine machine(setup, [](BaseProtocolBridge& bridge, const std::string& name) {
        auto memory = std::make_unique<BlockingMemory>((name + "_bus").c_str(), sc_core::sc_time(5, sc_core::SC_NS));
        memory->waits = true;
        bridge.to_memory.bind(memory->socket);
        return memory;
    });
    sc_core::sc_start();
    machine.require_drained();
    expect_mesh(machine.monitor.mesh, bare_mesh(setup));
}

TEST_CASE("bridged machine: one memory for both sides of the displacement map, the same mesh") {
    const MachineSetup setup = setup_of(with_settings(timed_job(), "hardware.height_test=curvature"));
    BridgedMachine machine(setup, blocking_5_ns);
    sc_core::sc_start();
    machine.require_drained();
    CHECK(machine.machine.displacement_map_for_tests->transactions() == 0);
    expect_mesh(machine.monitor.mesh, bare_mesh(setup));
}

TEST_CASE("bridged machine: pipelined memories and a queue that spills") {
    expect_same_cycles(with_settings(full_split_job(3, 3), "hardware.queue_capacity=16 " + every_table("latency", 7)));
}

TEST_CASE("bridged machine: three Tessellation Tests units share the bridges") {
    expect_same_cycles(with_settings(full_split_job(3, 3), "hardware.tests_units=3"));
}

namespace {

/// Keeps the kernel awake.
struct Ticker : sc_core::sc_module {
    explicit Ticker(const sc_core::sc_module_name& name) : sc_module(name) {
        SC_HAS_PROCESS(Ticker);
        SC_THREAD(tick);
    }

  private:
    void tick() {
        for (;;)
            wait(sc_core::sc_time(100, sc_core::SC_NS));
    }
};

/// Answers some accesses at once, then none.
struct SilentMemory : sc_core::sc_module {
    tlm_utils::passthrough_target_socket<SilentMemory> socket{"socket"};
    Bytes bytes;
    unsigned answers = 20;    ///< accesses that it answers
    bool accepts = false;     ///< END_REQ comes
    std::uint64_t asked = 0;  ///< address of the first access without an answer
    sc_core::sc_time since;
    unsigned unanswered = 0;

    explicit SilentMemory(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_nb_transport_fw(this, &SilentMemory::nb_transport_fw);
        socket.register_b_transport(this, &SilentMemory::b_transport);
        socket.register_transport_dbg(this, &SilentMemory::transport_dbg);
    }

  private:
    bool answered(tlm::tlm_generic_payload& payload) {
        if (answers > 0) {
            --answers;
            bytes.access(payload);
            return true;
        }
        if (unanswered++ == 0) {
            asked = payload.get_address();
            since = sc_core::sc_time_stamp();
        }
        return false;
    }
    tlm::tlm_sync_enum nb_transport_fw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase, sc_core::sc_time&) {
        if (answered(payload))
            return tlm::TLM_COMPLETED;
        if (!accepts)
            return tlm::TLM_ACCEPTED;
        phase = tlm::END_REQ;
        return tlm::TLM_UPDATED;
    }
    void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time&) {
        if (!answered(payload))
            wait(never_);
    }
    unsigned transport_dbg(tlm::tlm_generic_payload& payload) { return bytes.access(payload); }

    sc_core::sc_event never_{"never"};
};

struct Silent {
    std::string name;
    std::string settings;
    std::string memory;
    std::string port;
    bool accepts = false;
};

const CaseTable<Silent> silent{
    "a bridged memory that no longer answers, while another module keeps the kernel awake, is an error: ",
    {
        {"timed, the normal map, neither END_REQ nor answer", "mode=timed", "normal_map", "normal_test.normal_map"},
        {"timed, the normal map, no answer", "mode=timed", "normal_map", "normal_test.normal_map", true},
        {"timed, the displacement map", "mode=timed", "displacement_map", "displace_vertex.displacement_map"},
        {"timed, the Summed Height Table", "mode=timed", "summed_height_table",
         "summed_height_test.summed_height_table", true},
        {"timed, behind a cache", "mode=timed timing.normal_map_cache_bytes=1024", "normal_map",
         "normal_map_cache.table"},
        {"timed, off-chip memory", "mode=timed hardware.queue_capacity=4", "off_chip_memory",
         "triangle_queue.off_chip_memory", true},
        {"timed, modern design", "mode=timed hardware.design=modern", "normal_map", ".normal_map", true},
        {"functional, the normal map", "mode=functional", "normal_map", "normal_test.normal_map"},
        {"functional, the displacement map", "mode=functional", "displacement_map", "displace_vertex.displacement_map"},
        {"functional, modern design", "mode=functional hardware.design=modern", "summed_height_table",
         "summed_height_test.summed_height_table"},
    },
    [](const Silent& row) {
        MachineSetup setup = setup_of(with_settings({}, row.settings));
        setup.design.answer_cycles = 2000;
        SilentMemory* memory = nullptr;
        BridgedMachine machine(setup, [&](BaseProtocolBridge& bridge, const std::string& name) {
            if (name != row.memory)
                return blocking_5_ns(bridge, name);
            auto its = std::make_unique<SilentMemory>((name + "_bus").c_str());
            its->accepts = row.accepts;
            bridge.to_memory.bind(its->socket);
            memory = its.get();
            return std::unique_ptr<sc_core::sc_module>(std::move(its));
        });
        const Ticker ticker("ticker");
        const std::string error = error_of([] { sc_core::sc_start(sc_core::sc_time(10, sc_core::SC_MS)); });
        CAPTURE(error);
        REQUIRE(memory->unanswered > 0);
        std::ostringstream address;
        address << std::hex << "0x" << memory->asked;
        CHECK_THAT(error, Contains("bridged.") && Contains(row.port + ": ") && Contains("has waited since ") &&
                              Contains("10 us") &&
                              Contains("if what is behind the socket is only slow, raise Design::answer_cycles"));
        if (row.settings.find("mode=functional") == 0)
            CHECK_THAT(error, Contains(" " + address.str() + " ") && Contains("since " + memory->since.to_string()));
        else
            CHECK_THAT(error, Contains("bridge_of_" + row.memory));
        CHECK((error.find("END_REQ") != std::string::npos) == (row.settings.find("mode=timed") == 0 && !row.accepts));
        const sc_core::sc_time limit(10, sc_core::SC_US);
        CHECK(sc_core::sc_time_stamp() >= limit);
        CHECK(sc_core::sc_time_stamp() <= memory->since + limit + limit);
    }};

}  // namespace

TEST_CASE("a bridged memory has no limit for its answers if answer_cycles is 0") {
    MachineSetup setup = setup_of(timed_job());
    setup.design.answer_cycles = 0;
    BridgedMachine machine(
        setup, [](BaseProtocolBridge& bridge, const std::string& name) { return bound<SilentMemory>(bridge, name); });
    const Ticker ticker("ticker");
    sc_core::sc_start(sc_core::sc_time(10, sc_core::SC_MS));
    CHECK_FALSE(machine.machine.idle());
}

TEST_CASE("a bridged memory that is slow, within the limit, is no error, and the watch ends with the machine") {
    MachineSetup setup = setup_of(with_settings(full_split_job(2, 2), "tests.normal=false"));
    setup.design.answer_cycles = 20'000;  // 100 us; several requests of four entries wait for one another
    BridgedMachine machine(setup, [](BaseProtocolBridge& bridge, const std::string& name) {
        return bound<BlockingMemory>(bridge, name, sc_core::sc_time(1, sc_core::SC_US));
    });
    sc_core::sc_start();
    machine.require_drained();
    const sc_core::sc_time cycle(setup.design.timing.cycle_picoseconds, sc_core::SC_PS);
    CHECK(sc_core::sc_time_stamp() <= cycle * static_cast<double>(machine.cycles()));
    expect_mesh(machine.monitor.mesh, bare_mesh(setup));
}

TEST_CASE("two machines that spill to the same addresses of one memory are an error") {
    const MachineSetup setup = setup_of(with_settings(full_split_job(3, 3), "hardware.queue_capacity=4"));
    MachineSetup other = setup;
    std::reverse(other.base_triangles.begin(), other.base_triangles.end());
    SharedMemory memory("memory");
    const BridgedMemory make = [&](BaseProtocolBridge& bridge,
                                   const std::string& name) -> std::unique_ptr<sc_core::sc_module> {
        if (name != "off_chip_memory")
            return blocking_5_ns(bridge, name);
        bridge.to_memory.bind(memory.socket);
        return nullptr;
    };
    BridgedUnits first_units(setup.design.timing, make), second_units(setup.design.timing, make);
    NamedMachine first("first", setup, &first_units), second("second", other, &second_units);
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains("triangle_queue.off_chip_memory: ") && Contains("no longer holds a triangle") &&
                   Contains("give each machine a memory, or addresses, of its own"));
}

TEST_CASE("two machines that spill to the same addresses of a memory each draw their meshes") {
    const MachineSetup setup = setup_of(with_settings(full_split_job(3, 3), "hardware.queue_capacity=4"));
    MachineSetup other = setup;
    std::reverse(other.base_triangles.begin(), other.base_triangles.end());
    SharedMemory memory("memory"), other_memory("other_memory");
    const auto joined = [](SharedMemory& spilled) {
        return BridgedMemory(
            [&](BaseProtocolBridge& bridge, const std::string& name) -> std::unique_ptr<sc_core::sc_module> {
                if (name != "off_chip_memory")
                    return blocking_5_ns(bridge, name);
                bridge.to_memory.bind(spilled.socket);
                return nullptr;
            });
    };
    BridgedUnits first_units(setup.design.timing, joined(memory)),
        second_units(setup.design.timing, joined(other_memory));
    NamedMachine first("first", setup, &first_units), second("second", other, &second_units);
    sc_core::sc_start();
    expect_bare_mesh(first);
    expect_bare_mesh(second);
}
