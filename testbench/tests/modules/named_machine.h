#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "modules/rasteriser.h"
#include "testbench/common/child_process.h"
#include "testbench/machine/hosted_machine.h"
#include "testbench/machine/mesh_monitor.h"
#include "testbench/tests/support/bare_mesh.h"

namespace tessera::testing {

/// A machine with its whole environment under a name of its own: several can be in one simulation, which the test
/// starts.
struct NamedMachine : sc_core::sc_module {
    const MachineSetup& setup;
    Machine machine;
    Host host;
    Rasteriser rasteriser;
    MeshMonitor monitor;
    std::vector<sc_core::sc_time> drained;  ///< when its event fired

    /// `setup` must outlive the machine.
    NamedMachine(const sc_core::sc_module_name& name, const MachineSetup& its_setup, UnitFactory* units = nullptr)
        : sc_module(name),
          setup(its_setup),
          machine("pipeline", setup.registers, setup.design, units),
          host("host", machine, setup.base_triangles, tables_of(setup)),
          rasteriser("rasteriser", machine.clock, setup.design.timing.stalls),
          monitor("monitor", setup.registers.back_face_culling, 1'000'000) {
        host.bind();
        machine.lighting.to_rasteriser.bind(rasteriser.from_lighting);
        machine.pass_or_tessellate.finished.bind(monitor);
        machine.clock.halt_without_progress_for(1'000'000);
        SC_HAS_PROCESS(NamedMachine);
        SC_METHOD(note_drained);
        dont_initialize();
        sensitive << machine.drained();
    }

    std::uint64_t cycles() const { return machine.clock.last_cycle() + 1; }
    bool finished() const { return host.idle() && machine.idle() && !machine.clock.halted(); }

  private:
    void note_drained() { drained.push_back(sc_core::sc_time_stamp()); }
};

/// Requires that it has drained and emitted these triangles.
inline void expect_mesh(const NamedMachine& machine, const EmittedMesh& expected) {
    INFO(machine.name());
    CHECK(machine.finished());
    expect_mesh(machine.monitor.mesh, expected);
}
inline void expect_bare_mesh(const NamedMachine& machine) {
    expect_mesh(machine, bare_mesh(machine.setup));
}

/// The result of a machine in a simulation of its own.
struct AloneResult {
    std::uint64_t cycles = 0;
    std::uint64_t drained = 0;  ///< when for the last time, in time steps
};

/// Runs one in a child process, since SystemC elaborates once per process. Call it before anything is elaborated.
inline AloneResult run_alone(const MachineSetup& setup) {
    const ChildEnd end = run_in_child([&]() -> std::string {
        NamedMachine machine("machine", setup);
        sc_core::sc_start();
        if (!machine.finished() || machine.drained.empty())
            return {};
        return std::to_string(machine.cycles()) + " " + std::to_string(machine.drained.back().value());
    });
    REQUIRE(end.failure.empty());
    AloneResult result;
    REQUIRE(std::istringstream(end.told) >> result.cycles >> result.drained);
    REQUIRE(result.drained > 0);
    return result;
}

}  // namespace tessera::testing
