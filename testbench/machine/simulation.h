#pragma once
#include <cstdint>
#include <string>

#include "testbench/machine/host.h"
#include "testbench/machine/mesh_monitor.h"
#include "testbench/machine/rasteriser.h"

namespace tessera {

/// The machine with all that surrounds it: host, rasteriser, mesh monitor. One per process (SystemC elaborates once).
struct Simulation {
    /// `setup` must outlive the simulation. triangle_limit: see MeshMonitor. cycles_without_progress: timed mode, how
    /// long no triangle may be decided; 0: for ever.
    /// units: see Pipeline; null: the machine's own.
    Simulation(const MachineSetup& setup, std::uint64_t triangle_limit,
               std::uint64_t cycles_without_progress = 0, UnitFactory* units = nullptr);

    /// Runs until nothing is left to do. Empty: everything drained. Else a deadlock or livelock: what
    /// happened, and what each unit holds and waits for, one line each. Throws ResourceError when the mesh
    /// reaches the triangle limit, or the Triangle Queue its capacity where that is an error.
    std::string run();

    /// Timed mode: cycles from the first to the end of the last in which anything happened.
    std::uint64_t cycles() const { return cycles_; }

    const MachineSetup& setup;
    Pipeline pipeline;
    Host host;
    Rasteriser rasteriser;
    MeshMonitor monitor;

  private:
    bool drained() const;
    std::string stuck() const;

    std::uint64_t cycles_ = 0;
};

}  // namespace tessera
