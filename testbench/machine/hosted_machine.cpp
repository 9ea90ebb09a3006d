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
    : pipeline(numbered("tessera", number).c_str(), setup.registers, setup.design, units),
      host(numbered("host", number).c_str(), pipeline, setup.base_triangles, tables_of(setup), number, setup.machines),
      rasteriser(numbered("rasteriser", number).c_str(), pipeline.clock, setup.design.timing.stalls),
      decisions(setup),
      monitor_(monitor) {
    if (units != nullptr)
        units->made(host);
    host.bind();
    pipeline.lighting.to_rasteriser.bind(rasteriser.from_lighting);
    pipeline.pass_or_tessellate.decided.bind(decisions);
    pipeline.pass_or_tessellate.decided.bind(monitor);
    pipeline.pass_or_tessellate.finished.bind(*this);
}

void HostedMachine::finish(std::uint64_t cycles) {
    for (Unit* unit : pipeline.units())
        unit->activity().finish(cycles);
    pipeline.triangle_queue.history().finish(cycles);
}

}  // namespace tessera
