#include "testbench/machine/bare_recursion.h"

#include <algorithm>
#include <cstring>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/transform.h"

namespace tessera {

using namespace datapath;  // this file consists of calls to the datapath

namespace {

// The tables as arrays: a layout of one "byte" per entry turns the datapath's addresses into indices.
TableLayout as_indices(const TableLayout& layout) {
    return {0, layout.columns, layout.rows, 1};
}

/// Separate from evaluate_edge and not inlined, as in the unit (modules/units/edge_tests/normal.h): a design without
/// the test spends no register on it.
[[gnu::noinline]] void test_for_highlight(TrianglePass& pass, int k, const TestParameters& tests) {
    EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
    if (highlight_test(pass.edge_begin(k).displaced_normal, pass.edge_end(k).displaced_normal, edge.displaced_normal,
                       tests))
        edge.tests |= highlight_bit;
}

}  // namespace

BareRecursion::BareRecursion(const MachineSetup& setup)
    : setup_(setup), height_test_(functions_of(setup.registers.formats.height_test)) {
    const MapGeometry& map = setup.registers.map;
    const Formats& formats = setup.registers.formats;
    normals_.reserve(setup.map.codes.size());
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x)
            normals_.push_back(pack_normal(
                tessera::map_normal(setup.map, x, y, setup.height_per_code, setup.texel_size, formats.normal),
                formats.normal.bits));
    const TableLayout& table = setup.registers.height_table;
    height_table_.resize(table.bytes() + sizeof(std::uint64_t));
    for (unsigned k = 0; k < table.entry_bytes; ++k)
        height_entry_mask_ = height_entry_mask_ << 8 | 0xff;
    write_height_table(setup, [&](std::uint64_t address, const unsigned char* bytes, std::size_t count) {
        std::copy_n(bytes, count, height_table_.begin() + static_cast<std::ptrdiff_t>(address - table.base));
    });
}

HeightDecision BareRecursion::test_heights(const HeightEdge& edge) const {
    static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "tables are read as their bytes lie in memory");
    const Registers& r = setup_.registers;
    Reads reads;
    height_test_.reads(edge, r, reads);
    Entries entries;  // NOLINT(cppcoreguidelines-pro-type-member-init): as many as are read
    const bool codes = reads.last_port() == 1;
    for (unsigned k = 0; k < reads.entries(); ++k) {
        const std::uint64_t address = reads.addresses()[k];
        if (codes) {
            entries[k] = setup_.heights()[(address - r.displacement_map.base) / r.displacement_map.entry_bytes];
        } else {
            std::memcpy(&entries[k], &height_table_[address - r.height_table.base], sizeof entries[k]);
            entries[k] &= height_entry_mask_;
        }
    }
    HeightDecision decision;
    height_test_.decide(edge, entries, r, decision);
    return decision;
}

Direction BareRecursion::map_normal_at(const TexCoord& t) const {
    const Registers& r = setup_.registers;
    return datapath::map_normal(t, entries_at(t, r.normal_map, normals_).data(), r.formats);
}

std::uint32_t BareRecursion::code_at(const TexCoord& t) const {
    const Registers& r = setup_.registers;
    return map_code(t, entries_at(t, r.displacement_map, setup_.heights()).data(), r.formats);
}

template <class Entry>
std::array<std::uint64_t, 4> BareRecursion::entries_at(const TexCoord& t, const TableLayout& layout,
                                                       const std::vector<Entry>& map) const {
    const Registers& r = setup_.registers;
    std::array<std::uint64_t, 4> entries{};
    std::size_t count = 0;
    map_entries(t, as_indices(layout), r.map, r.formats, [&](std::uint64_t index) { entries[count++] = map[index]; });
    return entries;
}

void BareRecursion::complete_base(Triangle& triangle) {
    const Registers& r = setup_.registers;
    for (Vertex& v : triangle.vertices) {
        v.displaced = displace(v.position, v.normal, code_at(v.texture), r.displacement, r.formats, saturations_);
        v.screen = transform(v.displaced, r.transform, r.formats, saturations_);
        v.displaced_normal = bump(v.normal, v.tangent, v.handedness, map_normal_at(v.texture), r.formats, saturations_);
        v.displaced_known = true;
    }
}

void BareRecursion::evaluate_edge(TrianglePass& pass, int k) {
    const Registers& r = setup_.registers;
    const Vertex& i = pass.edge_begin(k);
    const Vertex& j = pass.edge_end(k);
    NewVertex& made = pass.new_vertex[static_cast<std::size_t>(k)];
    EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
    made.position = midpoint(i.position, j.position);
    made.texture = edge.texture = midpoint(i.texture, j.texture);  // both branches calculate it
    made.mean_normal = midpoint(i.normal, j.normal);
    edge.normal = normalise(made.mean_normal, r.formats, saturations_);
    edge.tangent = normalise(midpoint(i.tangent, j.tangent), r.formats, saturations_);
    made.displaced =
        displace(made.position, edge.normal, code_at(made.texture), r.displacement, r.formats, saturations_);
    made.screen = transform(made.displaced, r.transform, r.formats, saturations_);
    edge.displaced_normal = bump(edge.normal, edge.tangent, inserted_handedness(i.handedness, j.handedness),
                                 map_normal_at(made.texture), r.formats, saturations_);

    unsigned tests = 0;
    if (r.tests.normal_test && normal_test(i.displaced_normal, j.displaced_normal, edge.displaced_normal, r.tests))
        tests |= normal_bit;
    edge.rank = 0;
    if (r.tests.summed_height_test) {
        const HeightDecision decision =
            test_heights({i.texture, j.texture, edge.texture, false, 0, 0, edge_in_view(i.screen, j.screen)});
        edge.rank = decision.rank;
        if (decision.asks)
            tests |= summed_height_bit;
    }
    if (!r.tests.view_test || view_test(i.screen, j.screen, r.tests))
        tests |= view_bit;
    if (!r.tests.tex_coord_test || tex_coord_test(i.texture, j.texture, made.texture, r.formats))
        tests |= tex_coord_bit;
    if (!r.tests.generation_test || generation_test(i.generation, j.generation, r.tests))
        tests |= generation_bit;
    edge.tests = static_cast<std::uint8_t>(tests);
    edge.evaluated = all_tests;
}

void BareRecursion::evaluate(TrianglePass& pass) {
    unsigned asked = 0;
    unsigned stopped_by = 0;
    for (int k = 0; k < 3; ++k) {
        evaluate_edge(pass, k);
        if (setup_.registers.tests.highlight_test)
            test_for_highlight(pass, k, setup_.registers.tests);
        const std::uint8_t tests = pass.edges[static_cast<std::size_t>(k)].tests;
        if (split_decision(tests))
            asked |= 1u << k;
        else if ((tests & requesting_tests) != 0)
            stopped_by |= ~tests & gating_tests;
    }
    pass.split = static_cast<std::uint8_t>(edges_to_split(asked, setup_.registers.triangulation, pass));
    pass.triangle.stopped_by = static_cast<std::uint8_t>(asked == 0 ? stopped_by : 0);
}

ChildIndices BareRecursion::children_of(const TrianglePass& pass) const {
    const auto displaced = [&](std::uint8_t index) -> const Position& {
        return index < 3 ? pass.triangle.vertices[index].displaced : pass.new_vertex[index - 3u].displaced;
    };
    return triangulate(pass.split, choose_second_diagonal(pass.split, setup_.registers.triangulation, displaced));
}

void BareRecursion::transform_normals(Triangle& triangle) {
    for (Vertex& v : triangle.vertices)
        if (!v.screen_normal_known)
            v.screen_normal = transform_normal(v.displaced_normal, setup_.registers.transform, setup_.registers.formats,
                                               saturations_);
}

namespace {

/// Records finished triangles only.
struct Emit {
    struct Note {};
    EmittedMesh& mesh;

    static Note begin(const Triangle&) { return {}; }
    static void decided(const TrianglePass&, const ChildIndices&, const Note&) {}
    static Note child(const std::array<std::uint8_t, 3>&) { return {}; }
    void finished(const Triangle& triangle, bool culled) {
        mesh.triangles.push_back(EmittedTriangle::from(triangle, culled));
    }
};

}  // namespace

std::uint64_t BareRecursion::run(EmittedMesh& mesh, std::uint64_t most_edges) {
    mesh.triangles.clear();
    Emit emit{mesh};
    return walk(emit, most_edges);
}

}  // namespace tessera
