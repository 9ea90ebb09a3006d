#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "modules/datapath/pack_triangle.h"
#include "modules/memories/base_protocol_bridge.h"
#include "testbench/tests/modules/memories/base_protocol_memories.h"
#include "testbench/tests/support/bare_mesh.h"
#include "testbench/tests/support/job_results.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"

// The machine with memories of the base protocol in place of its own: the same mesh, and the same cycles if the
// latencies are equal.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// Makes the memory that replaces the machine's memory of this name, and binds the bridge to it.
using Maker = std::function<std::unique_ptr<sc_core::sc_module>(BaseProtocolBridge&, const std::string&)>;

template <class Memory, class... Arguments>
std::unique_ptr<sc_core::sc_module> bound(BaseProtocolBridge& bridge, const std::string& name,
                                          const Arguments&... arguments) {
    auto memory = std::make_unique<Memory>((name + "_bus").c_str(), arguments...);
    bridge.to_memory.bind(memory->socket);
    return memory;
}

class BridgedUnits : public UnitFactory {
  public:
    BridgedUnits(const Timing& timing, Maker make) : timing_(timing), make_(std::move(make)) {}

    void join(MemoryPort& port, TableMemory& memory) override { join_any(port, memory, 1); }
    void join(MemoryPort& port, OffChipMemory& memory) override {
        join_any(port, memory, timing_.off_chip_memory.buffer);
    }
    BaseProtocolBridge& bridge(const std::string& memory) { return *bridges_.at(memory); }

  private:
    void join_any(MemoryPort& port, const MemoryServer& memory, unsigned buffer) {
        std::string name = memory.basename();
        if (name == "displacement_map_for_tests")
            name = "displacement_map";
        if (bridges_.count(name) == 0) {
            auto* clock = dynamic_cast<CycleScheduler*>(sc_core::sc_find_object("bridged.clock"));
            bridges_[name] = std::make_unique<BaseProtocolBridge>(("bridge_of_" + name).c_str(), *clock, buffer);
            memories_.push_back(make_(*bridges_[name], name));
        }
        port.bind(*bridges_[name]);
    }

    Timing timing_;
    Maker make_;
    std::map<std::string, std::unique_ptr<BaseProtocolBridge>> bridges_;
    std::vector<std::unique_ptr<sc_core::sc_module>> memories_;
};

/// The machine with such memories, which the host fills.
struct BridgedMachine {
    BridgedUnits units;
    Pipeline pipeline;
    Host host;
    Rasteriser rasteriser;
    MeshMonitor monitor;

    BridgedMachine(const MachineSetup& setup, Maker make)
        : units(setup.design.timing, std::move(make)),
          pipeline("bridged", setup.registers, setup.design, &units),
          host("bridged_host", pipeline, setup.base_triangles, tables_of(setup)),
          rasteriser("bridged_rasteriser", pipeline.clock, setup.design.timing.stalls),
          monitor("bridged_monitor", setup.registers.back_face_culling, 1'000'000) {
        host.to_get_triangle.bind(pipeline.get_triangle.from_host);
        host.displacement_map.bind(units.bridge("displacement_map").host);
        host.normal_map.bind(units.bridge("normal_map").host);
        host.summed_height_table.bind(units.bridge(pipeline.height_table.basename()).host);
        pipeline.lighting.to_rasteriser.bind(rasteriser.from_lighting);
        pipeline.pass_or_tessellate.finished.bind(monitor);
    }
    std::uint64_t cycles() const { return pipeline.clock.last_cycle() + 1; }
    void require_drained() const {
        CHECK(pipeline.idle());
        CHECK(pipeline.height_table.transactions() == 0);
        CHECK(pipeline.displacement_map.transactions() == 0);
        CHECK(pipeline.off_chip_memory.bytes_written() == 0);
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
    CHECK(bridged.pipeline.triangle_queue.spilled() == simulation.pipeline.triangle_queue.spilled());
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
    CHECK(machine.pipeline.displacement_map_for_tests->transactions() == 0);
    expect_mesh(machine.monitor.mesh, bare_mesh(setup));
}

TEST_CASE("bridged machine: pipelined memories and a queue that spills") {
    expect_same_cycles(with_settings(full_split_job(3, 3), "hardware.queue_capacity=16 " + every_table("latency", 7)));
}

TEST_CASE("bridged machine: three Tessellation Tests units share the bridges") {
    expect_same_cycles(with_settings(full_split_job(3, 3), "hardware.tests_units=3"));
}
