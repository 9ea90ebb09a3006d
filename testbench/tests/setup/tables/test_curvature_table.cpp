#include "testbench/setup/tables/curvature_table.h"

#include <catch2/catch.hpp>

#include "modules/datapath/midpoint.h"
#include "modules/datapath/triangulate.h"
#include "testbench/tests/setup/tables/refined_mesh.h"

using namespace tessera;
using namespace tessera::tables_test;

namespace {

const datapath::Formats formats;

datapath::CurvatureEntry entry_at(const CurvatureTable& table, std::uint32_t x, std::uint32_t y, int level) {
    const TexCoord t{x << formats.texture.fraction, y << formats.texture.fraction};
    return datapath::unpack_curvature(
        table.entries[datapath::curvature_address(t, level, 0, table.covered, formats) / 5]);
}

double in_codes(std::int64_t value, const datapath::CurvatureEntry& entry) {
    return std::ldexp(static_cast<double>(value), entry.exponent - datapath::curvature_fraction);
}

/// Vertices in order of generation, for the paper's cut: all edges that split.
struct CutVertex {
    TexCoord t;
    int generation;
};
using CutTriangle = std::array<CutVertex, 3>;

struct CurvatureRecursion {
    const QuantisedMap& map;
    const CurvatureTable& table;
    std::uint64_t threshold;
    double metres_a_code, metres_a_texel;
    std::vector<Corners> finished;

    std::uint32_t code(const TexCoord& t) const {
        return static_cast<std::uint32_t>(code_at(map, t, formats.texture.fraction));
    }

    bool splits(const TexCoord& i, const TexCoord& j) const {
        const TexCoord ij = middle_of(i, j);
        if (!datapath::tex_coord_test(i, j, ij, formats))
            return false;
        const int level = datapath::curvature_level(i, j, formats);
        if (level == 1)
            return datapath::curvature_measure_of_codes(code(i), code(j), code(ij)) > threshold;
        const std::uint64_t at = datapath::curvature_address(ij, level, 0, table.covered, formats) / 5;
        return datapath::curvature_measure(datapath::unpack_curvature(table.entries[at]), i, j, level, formats) >
               threshold;
    }

    datapath::Position place(const TexCoord& t) const {  // decimetres
        const double texel = 10 * metres_a_texel / (1 << formats.texture.fraction);
        return {static_cast<std::int32_t>(t.u * texel), static_cast<std::int32_t>(t.v * texel),
                static_cast<std::int32_t>(code(t) * 10 * metres_a_code)};
    }

    void refine(const CutTriangle& triangle) {
        std::array<CutVertex, 6> vertices{};
        unsigned split = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const CutVertex &a = triangle[k], &b = triangle[(k + 1) % 3];
            vertices[k] = a;
            vertices[3 + k] = {middle_of(a.t, b.t), std::max(a.generation, b.generation) + 1};
            split |= vertices[3 + k].generation <= 15 && splits(a.t, b.t) ? 1u << k : 0;
        }
        if (split == 0) {
            finished.push_back({triangle[0].t, triangle[1].t, triangle[2].t});
            return;
        }
        const bool second = datapath::choose_second_diagonal(
            split, datapath::Triangulation::shorter, [&](std::uint8_t index) { return place(vertices[index].t); });
        const auto children = datapath::triangulate(split, second);
        for (int k = 0; k < children.count; ++k) {
            const auto& c = children.children[static_cast<std::size_t>(k)];
            refine({vertices[c[0]], vertices[c[1]], vertices[c[2]]});
        }
    }
};

}  // namespace

TEST_CASE("Every cell has a quadratic's curvature within rounding, and no remainder") {
    QuantisedMap map = empty_map(64, 48, AddressMode::clamp, AddressMode::clamp);
    for (std::uint32_t y = 0; y < 48; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x)
            map.codes[std::size_t{y} * 64 + x] =
                static_cast<std::uint16_t>(20000 + 3 * x * x + 5 * y + 30 * x - 2 * x * y - 2 * y * y);
    }
    const CurvatureTable table = make_curvature_table(map, {}, formats);
    CHECK(table.covered.width == 64);
    CHECK(table.entries.size() == datapath::curvature_entries(table.covered));
    for (int level = 2; level <= 4; ++level) {
        const auto entry = entry_at(table, 32, 24, level);  // its square lies within the map
        const double side = std::exp2(level), unit = in_codes(1, entry);
        CHECK(in_codes(entry.xx, entry) == Approx(3 * side * side / 4).margin(unit / 2));
        CHECK(in_codes(entry.xy, entry) == Approx(-2 * side * side / 4).margin(unit / 2));
        CHECK(in_codes(entry.yy, entry) == Approx(-2 * side * side / 4).margin(unit / 2));
        CHECK(entry.rest == 0);
        const datapath::TexCoord i{(32u << 12) - (2u << 12), 24u << 12}, j{(32u << 12) + (2u << 12), 24u << 12};
        if (level == 2)
            CHECK(datapath::curvature_measure(entry, i, j, 2, formats) == Approx(12 * 4 * 8).margin(32));
    }
}

TEST_CASE("The remainder of a quadratic is its RMS error") {
    Random random(1);
    QuantisedMap map = empty_map(32, 32, AddressMode::repeat, AddressMode::repeat);
    for (std::uint16_t& code : map.codes)
        code = random.coin() ? 11000 : 9000;
    const CurvatureTable table = make_curvature_table(map, {}, formats);
    const auto entry = entry_at(table, 16, 16, 5);
    CHECK(in_codes(entry.rest, entry) == Approx(1000).epsilon(0.02));
    // The same at a distance of whole periods.
    CHECK(datapath::pack_curvature(entry_at(table, 16 + 32, 16 + 64, 5)) == datapath::pack_curvature(entry));
}

TEST_CASE("Cells whose squares are beyond a clamped map are zero") {
    Random random(2);
    QuantisedMap map = empty_map(20, 20, AddressMode::clamp, AddressMode::clamp);
    for (std::uint16_t& code : map.codes)
        code = static_cast<std::uint16_t>(random.natural(0, 65535));
    const auto base = lattice_triangles(map.geometry, 32, formats);
    const CurvatureTable table = make_curvature_table(map, base, formats);
    CHECK(table.covered.width == 33);
    CHECK(table.covered.height == 33);
    for (int level = 2; level <= 3; ++level)
        for (std::uint32_t y = 0; y < 33; ++y)
            CHECK(datapath::pack_curvature(entry_at(table, 28, y, level)) == 0);
    CHECK(datapath::pack_curvature(entry_at(table, 16, 16, 3)) != 0);
}

TEST_CASE("At a clamped border a cell extends the border, times the root of the share of its square on the map") {
    Random random(3);
    QuantisedMap map = empty_map(17, 17, AddressMode::clamp, AddressMode::clamp);
    for (std::uint16_t& code : map.codes)
        code = static_cast<std::uint16_t>(random.natural(0, 65535));
    QuantisedMap wider = empty_map(49, 49, AddressMode::clamp, AddressMode::clamp);
    for (std::uint32_t y = 0; y < 49; ++y)
        for (std::uint32_t x = 0; x < 49; ++x)
            wider.codes[std::size_t{y} * 49 + x] = map.code(std::clamp(x, 16u, 32u) - 16, std::clamp(y, 16u, 32u) - 16);
    const CurvatureTable table = make_curvature_table(map, {}, formats);
    const CurvatureTable whole = make_curvature_table(wider, {}, formats);
    for (const std::uint32_t x : {0u, 8u, 16u}) {
        for (const std::uint32_t y : {0u, 8u, 16u}) {
            const auto part = entry_at(table, x, y, 4), all = entry_at(whole, x + 16, y + 16, 4);
            const double share = (x == 8 ? 17 : 9) * (y == 8 ? 17 : 9) / 289.0;
            const auto as_in_whole = [&](std::int64_t value, std::int64_t expected) {
                CHECK(in_codes(value, part) ==
                      Approx(std::sqrt(share) * in_codes(expected, all)).margin(in_codes(1, part) + in_codes(1, all)));
            };
            as_in_whole(part.xx, all.xx);
            as_in_whole(part.xy, all.xy);
            as_in_whole(part.yy, all.yy);
            as_in_whole(part.rest, all.rest);
        }
    }
}

TEST_CASE("Every possible value of a map fits an entry") {
    QuantisedMap map = empty_map(9, 9, AddressMode::clamp, AddressMode::clamp);
    for (std::uint32_t k = 0; k < 81; ++k)
        map.codes[k] = (k % 9 < 3 || k % 9 > 5) ? 65535 : 0;
    const CurvatureTable table = make_curvature_table(map, {}, formats);
    for (int level = 2; level <= 3; ++level) {
        const auto entry = entry_at(table, 4, 4, level);
        CHECK(in_codes(entry.xx, entry) > 60000);
        CHECK(entry.xx < 127);
    }
}

TEST_CASE("Crater Lake from 24 triangles by the Curvature Test, RMS in metres") {
    const CraterLake lake;
    const auto base = lattice_triangles(lake.map.geometry, 128, formats);
    const CurvatureTable table = make_curvature_table(lake.map, base, formats);
    const auto mesh_at = [&](std::uint64_t threshold) {
        CurvatureRecursion recursion{lake.map, table, threshold, lake.metres, 30, {}};
        for (const Corners& t : base)
            recursion.refine({CutVertex{t[0], 0}, CutVertex{t[1], 0}, CutVertex{t[2], 0}});
        return recursion.finished;
    };
    struct Row {
        std::size_t triangles;
        double rms;
    };
    for (const Row& row : {Row{2400, 8.8}, Row{4800, 5.8}, Row{9600, 3.8}, Row{19200, 2.42}}) {
        const auto mesh = mesh_at(threshold_for(row.triangles, 2'000'000, mesh_at));
        const double rms = lake.metres * error_figures(vertical_errors(lake.map, mesh, formats.texture.fraction)).rms;
        INFO(mesh.size() << " triangles: " << rms << " m");
        CHECK(rms <= row.rms);
    }
}
