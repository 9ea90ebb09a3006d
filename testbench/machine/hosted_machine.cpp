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
      host(numbered("host", number).c_str(), setup, pipeline.clock, number),
      rasteriser(numbered("rasteriser", number).c_str(), pipeline.clock, setup.design.timing.stalls),
      decisions(setup),
      monitor_(monitor) {
    if (units != nullptr)
        units->made(host);
    host.to_get_triangle.bind(pipeline.get_triangle.from_host);
    host.displacement_map.bind(pipeline.displacement_map.host);
    host.normal_map.bind(pipeline.normal_map.host);
    host.summed_height_table.bind(pipeline.summed_height_table.host);
    pipeline.lighting.to_rasteriser.bind(rasteriser.from_lighting);
    pipeline.pass_or_tessellate.decided.bind(decisions);
    pipeline.pass_or_tessellate.finished.bind(*this);
}

}  // namespace tessera
