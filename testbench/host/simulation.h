#pragma once
#include <string>

#include "testbench/host/host.h"
#include "testbench/host/mesh_monitor.h"
#include "testbench/host/rasteriser.h"

namespace tessera {

/// The machine with all that surrounds it: host, rasteriser, mesh monitor. One per process (SystemC elaborates once).
struct Simulation {
    /// `setup` must outlive the simulation. triangle_limit: see MeshMonitor.
    Simulation(const Setup& setup, std::uint64_t triangle_limit);

    /// Runs until nothing is left to do. Empty: everything drained. Else a deadlock: what each unit holds and waits
    /// for, one line each. Throws ResourceError when the mesh reaches the triangle limit.
    std::string run();

    Pipeline pipeline;
    Host host;
    Rasteriser rasteriser;
    MeshMonitor monitor;

  private:
    bool drained() const;
    std::string stuck() const;
};

}  // namespace tessera
