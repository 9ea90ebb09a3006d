#include "modules/datapath/map_entry.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

namespace {

/// One row of a table, entry by entry.
class TableRow {
  public:
    TableRow(const datapath::TableLayout& layout, const TableSink& sink)
        : layout_(layout), sink_(sink), bytes_(std::size_t{layout.columns} * layout.entry_bytes) {}

    void set(std::uint32_t column, std::uint64_t entry) {
        for (std::uint32_t k = 0; k < layout_.entry_bytes; ++k)
            bytes_[std::size_t{column} * layout_.entry_bytes + k] = static_cast<unsigned char>(entry >> (8 * k));
    }
    void write(std::uint32_t row) const { sink_(layout_.address(0, row), bytes_.data(), bytes_.size()); }

  private:
    const datapath::TableLayout& layout_;
    const TableSink& sink_;
    std::vector<unsigned char> bytes_;
};

void write_displacement_map(const PreparedScene& scene, const TableSink& sink) {
    const datapath::TableLayout& layout = scene.registers.displacement_map;
    TableRow row(layout, sink);
    for (std::uint32_t y = 0; y < layout.rows; ++y) {
        for (std::uint32_t x = 0; x < layout.columns; ++x)
            row.set(x, scene.heights()[std::size_t{y} * layout.columns + x]);
        row.write(y);
    }
}

void write_normal_map(const PreparedScene& scene, const TableSink& sink) {
    const datapath::TableLayout& layout = scene.registers.normal_map;
    const datapath::Format& format = scene.registers.formats.normal;
    TableRow row(layout, sink);
    for (std::uint32_t y = 0; y < layout.rows; ++y) {
        for (std::uint32_t x = 0; x < layout.columns; ++x)
            row.set(x, datapath::pack_normal(
                           map_normal(scene.map, x, y, scene.height_per_code, scene.texel_size, format), format.bits));
        row.write(y);
    }
}

void write_summed_height_table(const PreparedScene& scene, const TableSink& sink) {
    const datapath::TableLayout& layout = scene.registers.height_table;
    const auto mask = static_cast<std::uint64_t>(scene.registers.formats.summed_height.highest);
    TableRow row(layout, sink);
    std::vector<std::uint64_t> below(layout.columns, 0);
    row.write(0);
    for (std::uint32_t y = 0; y + 1 < layout.rows; ++y) {
        std::uint64_t along = 0;
        for (std::uint32_t x = 0; x + 1 < layout.columns; ++x) {
            along += scene.map.code(x, y);
            below[x + 1] = (below[x + 1] + along) & mask;
            row.set(x + 1, below[x + 1]);
        }
        row.write(y + 1);
    }
}

void write_rank_table(const PreparedScene& scene, const TableSink& sink) {
    const datapath::TableLayout& layout = scene.registers.height_table;
    const RankTables& tables = scene.rank_tables;
    TableRow row(layout, sink);
    for (std::uint32_t y = 0; y < layout.rows; ++y) {
        for (std::uint32_t x = 0; x < layout.columns; ++x) {
            const std::size_t k = std::size_t{y} * layout.columns + x;
            const std::uint64_t rank = tables.rank.empty() ? 0 : tables.rank[k];
            const std::uint64_t bound = tables.bound.empty() ? 0 : tables.bound[k];
            const std::uint64_t radius = tables.radius.empty() ? 0 : tables.radius[k];
            const datapath::Formats& formats = scene.registers.formats;
            row.set(x, rank | (bound | radius << formats.bound_bits) << formats.rank_bits);
        }
        row.write(y);
    }
}

template <class Entry>
void write_in_one_row(const datapath::TableLayout& layout, const std::vector<Entry>& entries, const TableSink& sink) {
    TableRow row(layout, sink);
    for (std::uint32_t k = 0; k < layout.columns; ++k)
        row.set(k, entries[k]);
    row.write(0);
}

}  // namespace

void write_tables(const PreparedScene& scene, const TableSink& sink) {
    write_displacement_map(scene, sink);
    write_normal_map(scene, sink);
    switch (scene.registers.formats.height_test) {
        case datapath::HeightTest::summed_height:
            write_summed_height_table(scene, sink);
            break;
        case datapath::HeightTest::rank:
            write_rank_table(scene, sink);
            break;
        case datapath::HeightTest::curvature:
            write_in_one_row(scene.registers.height_table, scene.curvature_table.entries, sink);
            break;
        case datapath::HeightTest::mipmap:
            write_in_one_row(scene.registers.height_table, scene.mipmap_table.entries, sink);
            break;
    }
}

}  // namespace tessera
