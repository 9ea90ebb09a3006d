#include "modules/datapath/map_entry.h"
#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/height_tests/table_rows.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

void write_tables(const PreparedScene& scene, const TableSink& sink) {
    const datapath::Registers& registers = scene.registers;
    write_rows(registers.displacement_map, sink, [&](std::uint32_t x, std::uint32_t y) {
        return scene.heights()[std::size_t{y} * registers.displacement_map.columns + x];
    });
    const datapath::Format& format = registers.formats.normal;
    write_rows(registers.normal_map, sink, [&](std::uint32_t x, std::uint32_t y) {
        return datapath::pack_normal(map_normal(scene.map, x, y, scene.height_per_code, scene.texel_size, format),
                                     format.bits);
    });
    write_height_table(scene, sink);
}

void write_height_table(const PreparedScene& scene, const TableSink& sink) {
    host_of(scene.registers.formats.height_test).write_table(scene, sink);
}

}  // namespace tessera
