#pragma once
#include <cstdint>
#include <string>

#include "testbench/machine/host.h"
#include "testbench/machine/mesh_monitor.h"
#include "testbench/machine/rasteriser.h"

namespace tessera {

/// The machine with host, rasteriser and mesh monitor. One per process (SystemC elaborates once).
struct Simulation {
    /// `setup` must outlive the simulation. triangle_limit: see MeshMonitor. cycles_without_progress: in timed mode,
    /// the limit on cycles without a decided triangle; 0: none.
    /// units: see Pipeline; null: the machine's own.
    Simulation(const MachineSetup& setup, std::uint64_t triangle_limit, std::uint64_t cycles_without_progress = 0,
               UnitFactory* units = nullptr);

    /// Runs until no work is left. Returns an empty string if all units drained, else a description of the deadlock or
    /// livelock with one line per unit: its contents and what it waits for. Throws ResourceError if the mesh reaches
    /// the triangle limit, or the Triangle Queue its capacity where that is an error.
    std::string run();

    /// Timed mode: cycles from the first to the end of the last with any activity.
    std::uint64_t cycles() const { return cycles_; }

    const MachineSetup& setup;
    Pipeline pipeline;
    Host host;
    Rasteriser rasteriser;
    Decisions decisions;
    MeshMonitor monitor;

  private:
    bool drained() const;
    std::string stuck() const;

    std::uint64_t cycles_ = 0;
};

}  // namespace tessera
