#include "modules/datapath/map_entry.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

namespace {

/// Writes row by row; calls entry(x, y) for column x of row y in this order.
template <class Entry>
void write_table(const datapath::TableLayout& layout, const TableSink& sink, Entry entry) {
    std::vector<unsigned char> bytes(std::size_t{layout.columns} * layout.entry_bytes);
    for (std::uint32_t y = 0; y < layout.rows; ++y) {
        for (std::uint32_t x = 0; x < layout.columns; ++x) {
            const std::uint64_t value = entry(x, y);
            for (std::uint32_t k = 0; k < layout.entry_bytes; ++k)
                bytes[std::size_t{x} * layout.entry_bytes + k] = static_cast<unsigned char>(value >> (8 * k));
        }
        sink(layout.address(0, y), bytes.data(), bytes.size());
    }
}

void write_summed_height_table(const PreparedScene& scene, const TableSink& sink) {
    const datapath::TableLayout& layout = scene.registers.height_table;
    const auto mask = static_cast<std::uint64_t>(scene.registers.formats.summed_height.highest);
    std::vector<std::uint64_t> below(layout.columns, 0);
    std::uint64_t along = 0;
    write_table(layout, sink, [&](std::uint32_t x, std::uint32_t y) -> std::uint64_t {
        if (x == 0)
            along = 0;
        if (x == 0 || y == 0)
            return 0;
        along += scene.map.code(x - 1, y - 1);
        return below[x] = (below[x] + along) & mask;
    });
}

void write_rank_table(const PreparedScene& scene, const TableSink& sink) {
    const datapath::TableLayout& layout = scene.registers.height_table;
    const RankTables& tables = scene.rank_tables;
    const datapath::Formats& formats = scene.registers.formats;
    write_table(layout, sink, [&](std::uint32_t x, std::uint32_t y) {
        const std::size_t k = std::size_t{y} * layout.columns + x;
        const std::uint64_t rank = tables.rank.empty() ? 0 : tables.rank[k];
        const std::uint64_t bound = tables.bound.empty() ? 0 : tables.bound[k];
        const std::uint64_t radius = tables.radius.empty() ? 0 : tables.radius[k];
        return rank | (bound | radius << formats.bound_bits) << formats.rank_bits;
    });
}

}  // namespace

void write_tables(const PreparedScene& scene, const TableSink& sink) {
    const datapath::Registers& registers = scene.registers;
    write_table(registers.displacement_map, sink, [&](std::uint32_t x, std::uint32_t y) {
        return scene.heights()[std::size_t{y} * registers.displacement_map.columns + x];
    });
    const datapath::Format& format = registers.formats.normal;
    write_table(registers.normal_map, sink, [&](std::uint32_t x, std::uint32_t y) {
        return datapath::pack_normal(map_normal(scene.map, x, y, scene.height_per_code, scene.texel_size, format),
                                     format.bits);
    });
    write_height_table(scene, sink);
}

void write_height_table(const PreparedScene& scene, const TableSink& sink) {
    const datapath::Registers& registers = scene.registers;
    switch (registers.formats.height_test) {
        case datapath::HeightTest::summed_height: write_summed_height_table(scene, sink); break;
        case datapath::HeightTest::rank: write_rank_table(scene, sink); break;
        case datapath::HeightTest::curvature:
            write_table(registers.height_table, sink,
                        [&](std::uint32_t x, std::uint32_t) { return scene.curvature_table.entries[x]; });
            break;
        case datapath::HeightTest::mipmap:
            write_table(registers.height_table, sink,
                        [&](std::uint32_t x, std::uint32_t) { return scene.mipmap_table.entries[x]; });
            break;
    }
}

}  // namespace tessera
