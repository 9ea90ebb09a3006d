#pragma once
#include <cstddef>
#include <cstdint>
#include <tlm>

#include "modules/host.h"
#include "modules/rasteriser.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/machine/mesh_monitor.h"

namespace tessera {

/// Fills a host's tables from the setup, which must outlive it.
inline Host::FillTables tables_of(const MachineSetup& setup) {
    return [&setup](const TableWriter& writer) { write_tables(setup, writer); };
}

/// One of the run's machines, with its host, rasteriser and decisions. Its finished triangles go to the monitor, which
/// all machines share.
class HostedMachine : private tlm::tlm_analysis_if<datapath::Triangle> {
  public:
    /// number: below setup.machines. `setup` and `monitor` must outlive it. units: see Machine.
    HostedMachine(const MachineSetup& setup, std::size_t number, MeshMonitor& monitor, UnitFactory* units);

    Machine machine;
    Host host;
    Rasteriser rasteriser;
    Decisions decisions;

    /// Timed mode: the last cycle with any activity.
    std::uint64_t last_cycle() const { return machine.clock.last_cycle(); }
    /// Timed mode: call at the end of a run of `cycles` cycles.
    void finish(std::uint64_t cycles);

    /// Nothing is left to send, and nothing in flight.
    bool drained() const { return host.idle() && machine.idle(); }

  private:
    void write(const datapath::Triangle& finished) override { monitor_.record(finished, &decisions); }

    MeshMonitor& monitor_;
};

}  // namespace tessera
