#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "modules/datapath/map_entry.h"
#include "modules/datapath/table_shapes.h"
#include "testbench/machine/bare_edges.h"

namespace tessera {

/// The contents of the three tables, one element per entry.
struct Tables {
    std::vector<std::uint32_t> codes;
    std::vector<std::uint64_t> normals;
    std::vector<std::uint64_t> heights;
};

/// Sets the tables' layouts for the other registers. Fills the Summed Height Table, each entry modulo its format;
/// another height test's table holds zeros.
inline Tables make_tables(datapath::Registers& registers, const std::vector<std::uint32_t>& codes,
                          const std::vector<datapath::Direction>& normals) {
    const datapath::Formats& formats = registers.formats;
    registers.displacement_map.base = 0x1000;
    registers.normal_map.base = 0x20000000;
    registers.height_table.base = 0x40000000;
    shape_tables(registers);
    const std::size_t columns = registers.height_table.columns, rows = registers.height_table.rows;
    Tables tables{codes, {}, std::vector<std::uint64_t>(columns * rows)};
    for (const datapath::Direction& n : normals)
        tables.normals.push_back(datapath::pack_normal(n, formats.normal.bits));
    if (formats.height_test != datapath::HeightTest::summed_height)
        return tables;
    const auto mask = static_cast<std::uint64_t>(formats.summed_height.highest);
    for (std::size_t y = 1; y < rows; ++y) {
        std::uint64_t row = 0;
        for (std::size_t x = 1; x < columns; ++x) {
            row += codes[(y - 1) * (columns - 1) + x - 1];
            tables.heights[y * columns + x] = (tables.heights[(y - 1) * columns + x] + row) & mask;
        }
    }
    return tables;
}

/// Edges of arbitrary registers and tables. Throws std::out_of_range if a read lies outside its table.
class EdgeMachine : public BareEdges<EdgeMachine> {
  public:
    EdgeMachine(const datapath::Registers& with, Tables tables)
        : BareEdges(with.formats.height_test), registers(with), tables_(std::move(tables)) {}

    datapath::Registers registers;

    bool summed_height(const datapath::TexCoord& i, const datapath::TexCoord& j) const {
        return test_heights({i, j, midpoint(i, j)}).asks;
    }

    using BareEdges::evaluate;
    datapath::TrianglePass evaluate(const datapath::Triangle& triangle) {
        datapath::TrianglePass pass;
        pass.triangle = triangle;
        evaluate(pass);
        return pass;
    }

    const datapath::Registers& scene_registers() const { return registers; }
    std::uint64_t code_entry(std::uint64_t index) const { return tables_.codes.at(index); }
    std::uint64_t normal_entry(std::uint64_t index) const { return tables_.normals.at(index); }
    std::uint64_t height_entry(std::uint64_t offset) const {
        return tables_.heights.at(offset / registers.height_table.entry_bytes);
    }

  private:
    Tables tables_;
};

inline bool same_bits(const datapath::Vertex& a, const datapath::Vertex& b) {
    return a.position == b.position && a.normal == b.normal && a.tangent == b.tangent && a.texture == b.texture &&
           a.handedness == b.handedness && a.generation == b.generation && a.displaced_known == b.displaced_known &&
           a.screen_normal_known == b.screen_normal_known && a.code == b.code && a.displaced == b.displaced &&
           a.displaced_normal == b.displaced_normal && a.screen == b.screen && a.screen_normal == b.screen_normal;
}

}  // namespace tessera
