#include <fmt/format.h>

#include <functional>

#include "testbench/tests/modules/named_machine.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_modules.h"

// What a host refuses before a frame begins.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

struct Refused {
    std::string name;
    std::function<void(MachineSetup&)> change;
    std::string says;
};

datapath::Vertex& vertex(MachineSetup& setup) {
    return setup.base_triangles.at(3).vertices[1];
}

const CaseTable<Refused> refused{
    "a host refuses a frame that the machine's arithmetic excludes: ",
    {
        {"handedness 0", [](auto& setup) { vertex(setup).handedness = 0; }, "base triangle 3"},
        {"a normal of nearly 2.0", [](auto& setup) { vertex(setup).normal.y = 32767; }, "base triangle 3"},
        {"a texture coordinate", [](auto& setup) { vertex(setup).texture.u = 0xffffffff; }, "base triangle 3"},
        {"ambient light", [](auto& setup) { setup.registers.light.ambient = 1000; }, "light.ambient"},
        {"a threshold", [](auto& setup) { setup.registers.tests.view_threshold = 0xfffffffb; }, "view_threshold"},
        {"a generation", [](auto& setup) { setup.registers.tests.generation_limit = 40; }, "generation_limit"},
    },
    [](const Refused& row) {
        MachineSetup setup = setup_of(with_settings({}, "map.width=16 map.height=16"));
        row.change(setup);
        NamedMachine machine("machine", setup);
        CHECK_THAT(error_of([] { sc_core::sc_start(); }), Contains("machine.host: ") && Contains(row.says));
        CHECK(machine.machine.edges_tested() == 0);
    }};

}  // namespace

TEST_CASE("a host refuses a table that is not filled") {
    MachineSetup setup = setup_of(with_settings({}, "map.width=16 map.height=16"));
    const datapath::TableLayout& map = setup.registers.normal_map;
    Machine machine("machine", setup.registers, setup.design);
    Host host("host", machine, setup.base_triangles, [&](const TableWriter& writer) {
        write_tables(setup, [&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
            writer(address, bytes, address - map.base < map.bytes() ? count / 2 : count);
        });
    });
    host.bind();
    Rasteriser rasteriser("rasteriser", machine.clock, setup.design.timing.stalls);
    machine.lighting.to_rasteriser.bind(rasteriser.from_lighting);
    CHECK_THAT(error_of([] { sc_core::sc_start(); }),
               Contains(fmt::format("host: FillTables wrote {} of the {} bytes of machine.normal_map", map.bytes() / 2,
                                    map.bytes())));
}
