#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "testbench/machine/hosted_machine.h"

namespace tessera {

/// A run: the machine with host, rasteriser and mesh monitor, or several machines side by side, which share only the
/// base mesh. One per process (SystemC elaborates once).
struct Simulation {
    /// `setup` must outlive the simulation. triangle_limit: see MeshMonitor. cycles_without_progress: in timed mode,
    /// the limit on cycles without a decided triangle; 0: none. units: see Machine; null: the machine's own.
    Simulation(const MachineSetup& setup, std::uint64_t triangle_limit, std::uint64_t cycles_without_progress = 0,
               UnitFactory* units = nullptr);

    /// Runs until no work is left. Returns an empty string if all units drained, else a description of the deadlock or
    /// livelock with one line per unit: its contents and what it is waiting for. Throws ResourceError if the mesh
    /// reaches the triangle limit, or the Triangle Queue its capacity if overflow is an error.
    std::string run();

    /// Timed mode: number of cycles from the first to the last with any activity, both included.
    std::uint64_t cycles() const { return cycles_; }

    /// Base triangles sent so far, by all hosts.
    std::uint64_t sent() const;
    /// The machine that finished last.
    const HostedMachine& last_machine() const;
    /// Binds `sink` to each machine's decided passes (Pass or Tessellate) and inserted vertices (Tessellation).
    void observe_decisions(tlm::tlm_analysis_if<datapath::TrianglePass>& sink);

    const MachineSetup& setup;
    MeshMonitor monitor;
    const std::vector<std::unique_ptr<HostedMachine>> machines;

    /// The machine, or the first of several.
    Machine& machine = machines.front()->machine;
    Host& host = machines.front()->host;
    Rasteriser& rasteriser = machines.front()->rasteriser;
    Decisions& decisions = machines.front()->decisions;

  private:
    void check_limits(const Machine& one) const;
    std::string stuck() const;
    static std::string stuck(const HostedMachine& hosted, const MachineSetup& setup);

    std::uint64_t cycles_ = 0;
    const bool only_own_units_;  // all units are those of modules/
};

}  // namespace tessera
