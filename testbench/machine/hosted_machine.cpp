#include "testbench/machine/hosted_machine.h"

#include <string>

namespace tessera {

namespace {

/// "tessera", "tessera_1", ...
std::string numbered(const char* name, std::size_t number) {
    return number == 0 ? name : name + ("_" + std::to_string(number));
}

}  // namespace

HostedMachine::HostedMachine(const MachineSetup& setup, std::size_t number, MeshMonitor& monitor, UnitFactory* units)
    : machine(numbered("tessera", number).c_str(), setup.registers, setup.design, units),
      host(numbered("host", number).c_str(), machine, setup.base_triangles, tables_of(setup), number, setup.machines),
      rasteriser(numbered("rasteriser", number).c_str(), machine.clock, setup.design.timing.stalls),
      decisions(setup),
      monitor_(monitor) {
    if (units != nullptr)
        units->made(host);
    host.bind();
    machine.lighting.to_rasteriser.bind(rasteriser.from_lighting);
    machine.pass_or_tessellate.decided.bind(decisions);
    machine.pass_or_tessellate.decided.bind(monitor);
    machine.pass_or_tessellate.finished.bind(*this);
}

void HostedMachine::finish(std::uint64_t cycles) {
    for (Unit* unit : machine.units())
        unit->activity().finish(cycles);
    machine.triangle_queue.history().finish(cycles);
}

}  // namespace tessera
