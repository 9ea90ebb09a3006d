#include "testbench/machine/bare_recursion.h"

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/curvature.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/map_entry.h"
#include "modules/datapath/midpoint.h"
#include "modules/datapath/mipmap.h"
#include "modules/datapath/rank_view.h"
#include "modules/datapath/rectangle.h"
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

BareRecursion::BareRecursion(const MachineSetup& setup) : setup_(setup) {
    const MapGeometry& map = setup.registers.map;
    const Formats& formats = setup.registers.formats;
    normals_.reserve(setup.map.codes.size());
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x)
            normals_.push_back(pack_normal(
                tessera::map_normal(setup.map, x, y, setup.height_per_code, setup.texel_size, formats.normal),
                formats.normal.bits));
    const bool narrow = formats.summed_height.bits <= 32;
    const std::size_t columns = std::size_t{map.width} + 1;
    std::vector<std::uint64_t> sums(columns * (std::size_t{map.height} + 1), 0);
    for (std::uint32_t y = 0; y < map.height; ++y) {
        std::uint64_t along = 0;
        for (std::uint32_t x = 0; x < map.width; ++x) {
            along += setup.map.code(x, y);
            sums[(y + 1) * columns + x + 1] = sums[y * columns + x + 1] + along;
        }
    }
    if (narrow)
        sums_.assign(sums.begin(), sums.end());
    else
        wide_sums_ = std::move(sums);
}

std::uint64_t BareRecursion::sum_around(const TexCoord& t, const RectangleSize& size) const {
    const Registers& r = setup_.registers;
    const Rectangle rectangle = centred_rectangle(t, size, r.map, r.formats);
    const TableLayout table = as_indices(r.height_table);
    if (!sums_.empty())
        return rectangle_sum(rectangle, r.map, table, r.formats,
                             [&](std::uint64_t index) { return std::uint64_t{sums_[index]}; });
    return rectangle_sum(rectangle, r.map, table, r.formats, [&](std::uint64_t index) { return wide_sums_[index]; });
}

bool BareRecursion::test_rank(const Vertex& i, const Vertex& j, EdgeTests& edge) const {
    const Registers& r = setup_.registers;
    if (!has_lattice_midpoint(i.texture, j.texture, r.formats))
        return false;
    const std::size_t index = rank_address(edge.texture, as_indices(r.height_table), r.map, r.formats);
    const RankTables& tables = setup_.rank_tables;
    const RankEntry entry{tables.rank.empty() ? 0u : tables.rank[index],
                          tables.bound.empty() ? 0u : tables.bound[index],
                          tables.radius.empty() ? 0u : tables.radius[index]};
    edge.rank = ordering_rank(entry, r.formats);
    return asks_by_rank(entry, edge_in_view(i.screen, j.screen), r.tests, r.formats);
}

std::uint64_t BareRecursion::curvature_of(const TexCoord& i, const TexCoord& j, const TexCoord& ij) const {
    const Registers& r = setup_.registers;
    const bool codes = curvature_by_codes(i, j, r.formats);
    std::array<std::uint64_t, 3> read{};
    std::size_t count = 0;
    curvature_reads(i, j, ij, r, [&](std::uint64_t address) {
        const TableLayout& table = codes ? r.displacement_map : r.height_table;
        const std::size_t index = (address - table.base) / table.entry_bytes;
        read[count++] = codes ? setup_.heights()[index] : setup_.curvature_table.entries[index];
    });
    return curvature_of_entries(i, j, read, r.formats);
}

std::uint64_t BareRecursion::mipmap_difference_of(const TexCoord& i, const TexCoord& j, const TexCoord& ij) const {
    const TableLayout& table = setup_.registers.height_table;
    std::array<std::uint64_t, 3> read{};
    std::size_t count = 0;
    mipmap_reads(i, j, ij, setup_.registers, [&](std::uint64_t address) {
        read[count++] = setup_.mipmap_table.entries[(address - table.base) / table.entry_bytes];
    });
    return datapath::mipmap_difference(read);
}

bool BareRecursion::test_heights(const Vertex& i, const Vertex& j, EdgeTests& edge) const {
    const Registers& r = setup_.registers;
    switch (r.formats.height_test) {
        case HeightTest::rank: return test_rank(i, j, edge);
        case HeightTest::curvature: return curvature_test(curvature_of(i.texture, j.texture, edge.texture), r.tests);
        case HeightTest::mipmap: return mipmap_test(mipmap_difference_of(i.texture, j.texture, edge.texture), r.tests);
        case HeightTest::summed_height: break;
    }
    const RectangleSize size = rectangle_size(i.texture, j.texture, r.map, r.formats);
    return summed_height_test(sum_around(i.texture, size), sum_around(j.texture, size), sum_around(edge.texture, size),
                              size, r.tests);
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
    if (r.tests.summed_height_test && test_heights(i, j, edge))
        tests |= summed_height_bit;
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
