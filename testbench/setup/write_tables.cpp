#include <fmt/core.h>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/map_entry.h"
#include "testbench/common/error.h"
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

namespace {

/// Throws InputError unless these bytes lie in the table, and no entry is wider than its format.
void check_written(const datapath::TableLayout& table, int bits, std::uint64_t address, const unsigned char* bytes,
                   std::size_t count) {
    const std::uint64_t offset = address - table.base;
    if (offset > table.bytes() || count > table.bytes() - offset)
        throw InputError(fmt::format("write_table() writes {} bytes from byte {} on, but the table has {} bytes", count,
                                     static_cast<std::int64_t>(offset), table.bytes()));
    if (bits % 8 == 0)
        return;
    const std::uint64_t size = table.entry_bytes;
    for (std::size_t k = size - 1 - offset % size; k < count; k += size)
        if (bytes[k] >> (bits % 8) != 0)
            throw InputError(
                fmt::format("write_table() writes an entry in which a bit above entry_bits() = {} is set: entry {}",
                            bits, (offset + k) / size));
}

}  // namespace

void write_height_table(const PreparedScene& scene, const TableSink& sink) {
    const datapath::HeightTestFunctions& test = functions_of(scene.registers.formats.height_test);
    const int bits = test.entry_bits(scene.registers.formats);
    try {
        host_of(scene.registers.formats.height_test)
            .write_table(scene, [&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
                check_written(scene.registers.height_table, bits, address, bytes, count);
                sink(address, bytes, count);
            });
    } catch (const InputError& fault) {
        throw InputError(fmt::format("height test {}: {}", test.name, fault.what()));
    }
}

}  // namespace tessera
