#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/normalise.h"
#include "modules/datapath/rectangle.h"
#include "modules/datapath/transform.h"
#include "modules/datapath/triangle_pass.h"

/// The machine's processing of vertices and edges, composed of the datapath's functions, without units or SystemC.
namespace tessera {

/// The contents of the three tables, one element per entry.
struct Tables {
    std::vector<std::uint32_t> codes;
    std::vector<std::uint64_t> normals;
    std::vector<std::uint64_t> sums;

    static std::size_t entry(std::uint64_t address, const datapath::TableLayout& table) {
        return static_cast<std::size_t>((address - table.base) / table.entry_bytes);
    }
};

/// Sets the tables' layouts for registers.map and fills the Summed Height Table, each entry modulo its format.
inline Tables make_tables(datapath::Registers& registers, const std::vector<std::uint32_t>& codes,
                          const std::vector<datapath::Direction>& normals) {
    const std::uint32_t width = registers.map.width, height = registers.map.height;
    const datapath::Formats& formats = registers.formats;
    registers.displacement_map = {0x1000, width, height, datapath::entry_bytes(formats.displacement.bits)};
    registers.normal_map = {0x20000000, width, height, datapath::entry_bytes(3 * formats.normal.bits)};
    registers.height_table = {0x40000000, width + 1, height + 1, datapath::entry_bytes(formats.summed_height.bits)};
    Tables tables;
    tables.codes = codes;
    for (const datapath::Direction& n : normals)
        tables.normals.push_back(datapath::pack_normal(n, formats.normal.bits));
    tables.sums.assign((std::size_t{width} + 1) * (std::size_t{height} + 1), 0);
    const std::uint64_t mask = static_cast<std::uint64_t>(formats.summed_height.highest);
    for (std::size_t y = 1; y <= height; ++y) {
        std::uint64_t row = 0;
        for (std::size_t x = 1; x <= width; ++x) {
            row += codes[(y - 1) * width + x - 1];
            tables.sums[y * (width + 1) + x] = (tables.sums[(y - 1) * (width + 1) + x] + row) & mask;
        }
    }
    return tables;
}

class Machine {
  public:
    Machine(datapath::Registers with, Tables tables) : registers(with), tables_(std::move(tables)) {}

    datapath::Registers registers;
    datapath::Saturations saturations;

    std::uint64_t sum_around(const datapath::TexCoord& t, const datapath::RectangleSize& size) const {
        const datapath::TableLayout& table = registers.height_table;
        return rectangle_sum(centred_rectangle(t, size, registers.map, registers.formats), registers.map, table,
                             registers.formats,
                             [&](std::uint64_t address) { return tables_.sums.at(Tables::entry(address, table)); });
    }

    bool summed_height(const datapath::TexCoord& i, const datapath::TexCoord& j) const {
        const datapath::RectangleSize size = rectangle_size(i, j, registers.map, registers.formats);
        return summed_height_test(sum_around(i, size), sum_around(j, size), sum_around(midpoint(i, j), size), size,
                                  registers.tests);
    }

    datapath::Direction bumped(const datapath::Direction& n, const datapath::Direction& t, int handedness,
                               const datapath::TexCoord& texture) {
        const auto entries = entries_at(texture, registers.normal_map, tables_.normals);
        return bump(n, t, handedness, map_normal(texture, entries.data(), registers.formats), registers.formats,
                    saturations);
    }

    datapath::Position displaced(const datapath::Position& p, const datapath::Direction& n,
                                 const datapath::TexCoord& texture) {
        const auto entries = entries_at(texture, registers.displacement_map, tables_.codes);
        return displace(p, n, map_code(texture, entries.data(), registers.formats), registers.displacement,
                        registers.formats, saturations);
    }

    /// Calculates a base vertex's values of its first pass.
    void complete(datapath::Vertex& vertex) {
        vertex.displaced = displaced(vertex.position, vertex.normal, vertex.texture);
        vertex.displaced_normal = bumped(vertex.normal, vertex.tangent, vertex.handedness, vertex.texture);
        vertex.screen = transform(vertex.displaced, registers.transform, registers.formats, saturations);
        vertex.displaced_known = true;
    }

    /// Both branches' work on edge k.
    void evaluate_edge(datapath::TrianglePass& pass, int k) {
        insert_vertex(pass, k);
        decide(pass, k);
    }

    /// Calculates only the vertex to be inserted on edge k.
    void insert_vertex(datapath::TrianglePass& pass, int k) {
        const datapath::Vertex& i = pass.edge_begin(k);
        const datapath::Vertex& j = pass.edge_end(k);
        const datapath::Formats& formats = registers.formats;
        datapath::NewVertex& made = pass.new_vertex[static_cast<std::size_t>(k)];
        made.position = midpoint(i.position, j.position);
        made.mean_normal = midpoint(i.normal, j.normal);
        made.texture = midpoint(i.texture, j.texture);
        made.displaced = displaced(made.position, normalise(made.mean_normal, formats, saturations), made.texture);
        made.screen = transform(made.displaced, registers.transform, formats, saturations);

        datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        edge.texture = midpoint(i.texture, j.texture);
        edge.normal = normalise(midpoint(i.normal, j.normal), formats, saturations);
        edge.tangent = normalise(midpoint(i.tangent, j.tangent), formats, saturations);
        edge.displaced_normal =
            bumped(edge.normal, edge.tangent, datapath::inserted_handedness(i.handedness, j.handedness), edge.texture);
    }

    /// Evaluates the tests of edge k, whose vertex is known.
    void decide(datapath::TrianglePass& pass, int k) const {
        const datapath::Vertex& i = pass.edge_begin(k);
        const datapath::Vertex& j = pass.edge_end(k);
        const datapath::Formats& formats = registers.formats;
        const datapath::TestParameters& parameters = registers.tests;
        datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        const auto bit = [](bool set, datapath::TestBits which) { return set ? int{which} : 0; };
        edge.tests = static_cast<std::uint8_t>(
            bit(parameters.normal_test &&
                    normal_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, parameters),
                datapath::normal_bit) |
            bit(parameters.highlight_test &&
                    highlight_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, parameters),
                datapath::highlight_bit) |
            bit(parameters.summed_height_test && summed_height(i.texture, j.texture), datapath::summed_height_bit) |
            bit(!parameters.view_test || view_test(i.screen, j.screen, parameters), datapath::view_bit) |
            bit(!parameters.tex_coord_test || tex_coord_test(i.texture, j.texture, edge.texture, formats),
                datapath::tex_coord_bit) |
            bit(!parameters.generation_test || datapath::generation_test(i.generation, j.generation, parameters),
                datapath::generation_bit));
        edge.evaluated = datapath::all_tests;
        if (datapath::split_decision(edge.tests))
            pass.split = static_cast<std::uint8_t>(pass.split | 1 << k);
    }

    datapath::TrianglePass evaluate(const datapath::Triangle& triangle) {
        datapath::TrianglePass pass;
        pass.triangle = triangle;
        for (int k = 0; k < 3; ++k)
            evaluate_edge(pass, k);
        return pass;
    }

  private:
    template <class Entry>
    std::array<std::uint64_t, 4> entries_at(const datapath::TexCoord& texture, const datapath::TableLayout& table,
                                            const std::vector<Entry>& map) const {
        std::array<std::uint64_t, 4> entries{};
        std::size_t count = 0;
        map_entries(texture, table, registers.map, registers.formats,
                    [&](std::uint64_t address) { entries.at(count++) = map.at(Tables::entry(address, table)); });
        return entries;
    }

    Tables tables_;
};

inline bool same_bits(const datapath::Vertex& a, const datapath::Vertex& b) {
    return a.position == b.position && a.normal == b.normal && a.tangent == b.tangent && a.texture == b.texture &&
           a.handedness == b.handedness && a.generation == b.generation && a.displaced_known == b.displaced_known &&
           a.screen_normal_known == b.screen_normal_known && a.code == b.code && a.displaced == b.displaced &&
           a.displaced_normal == b.displaced_normal && a.screen == b.screen && a.screen_normal == b.screen_normal;
}

}  // namespace tessera
