#include "testbench/setup/tables/fitted_heights.h"

#include <catch2/catch.hpp>

#include "testbench/setup/tables/rank_table.h"
#include "testbench/tests/setup/tables/refined_mesh.h"

using namespace tessera;
using namespace tessera::tables_test;

namespace {

const datapath::Formats formats;

/// Errors of the mesh with codes from `heights`, measured against `map`.
std::vector<double> errors_of(const QuantisedMap& heights, const QuantisedMap& map, const std::vector<Corners>& mesh) {
    return vertical_errors(map, mesh, formats.texture.fraction, &heights);
}

double squared(const std::vector<double>& errors) {
    double sum = 0;
    for (const double error : errors)
        sum += error * error;
    return sum;
}

}  // namespace

TEST_CASE("A mesh whose map is linear within its triangles, except for noise, gets the heights without noise") {
    Random random(1);
    QuantisedMap map = empty_map(65, 65, AddressMode::clamp, AddressMode::clamp);
    const auto level = [](std::uint32_t x, std::uint32_t y) { return 20000.0 + 100 * x + 50 * y; };
    for (std::uint32_t y = 0; y < 65; ++y)
        for (std::uint32_t x = 0; x < 65; ++x)
            map.codes[std::size_t{y} * 65 + x] = static_cast<std::uint16_t>(level(x, y) + random.integer32(-500, 500));
    const auto mesh = lattice_triangles(map.geometry, 32, formats);
    const QuantisedMap fitted = fit_heights(map, mesh, formats);
    for (std::uint32_t y = 0; y < 65; ++y) {
        for (std::uint32_t x = 0; x < 65; ++x)
            if (x % 32 == 0 && y % 32 == 0)
                CHECK(fitted.code(x, y) == Approx(level(x, y)).margin(120));
            else
                REQUIRE(fitted.code(x, y) == map.code(x, y));
    }
}

TEST_CASE("No other code under a vertex reduces the squared error") {
    Random random(2);
    for (int trial = 0; trial < 10; ++trial) {
        QuantisedMap map = empty_map(20, 17, AddressMode::clamp, AddressMode::clamp);
        for (std::uint16_t& code : map.codes)
            code = static_cast<std::uint16_t>(random.natural(28000, 32000));
        const auto mesh = lattice_triangles(map.geometry, 8, formats);
        QuantisedMap fitted = fit_heights(map, mesh, formats);
        const double least = squared(errors_of(fitted, map, mesh));
        CHECK(least < squared(errors_of(map, map, mesh)));
        for (std::uint32_t y = 0; y < 17; y += 8) {
            for (std::uint32_t x = 0; x < 20; x += 8) {
                std::uint16_t& code = fitted.codes[std::size_t{y} * 20 + x];
                for (const int change : {-3, 3}) {
                    code = static_cast<std::uint16_t>(code + change);
                    CHECK(squared(errors_of(fitted, map, mesh)) > least);
                    code = static_cast<std::uint16_t>(code - change);
                }
            }
        }
    }
}

TEST_CASE("Each of several meshes over the same texels counts") {
    Random random(3);
    QuantisedMap map = empty_map(33, 33, AddressMode::clamp, AddressMode::clamp);
    for (std::uint16_t& code : map.codes)
        code = static_cast<std::uint16_t>(random.natural(20000, 40000));
    const auto coarse = lattice_triangles(map.geometry, 32, formats);
    const auto fine = lattice_triangles(map.geometry, 16, formats);
    auto both = coarse;
    both.insert(both.end(), fine.begin(), fine.end());
    const auto of_both = [&](const QuantisedMap& heights) {
        return squared(errors_of(heights, map, coarse)) + squared(errors_of(heights, map, fine));
    };
    const double together = of_both(fit_heights(map, both, formats));
    CHECK(together < 0.999 * of_both(fit_heights(map, coarse, formats)));
    CHECK(together < 0.999 * of_both(fit_heights(map, fine, formats)));
}

TEST_CASE("Fitted heights stay within the range of codes") {
    QuantisedMap map = empty_map(17, 17, AddressMode::clamp, AddressMode::clamp);
    map.bits = 10;
    for (std::uint32_t k = 0; k < map.codes.size(); ++k)
        map.codes[k] = k % 17 < 8 ? 0 : 1023;
    const QuantisedMap fitted = fit_heights(map, lattice_triangles(map.geometry, 16, formats), formats);
    CHECK(*std::max_element(fitted.codes.begin(), fitted.codes.end()) == 1023);
}

TEST_CASE("Crater Lake by the Rank Test with fitted heights, RMS in metres") {
    const CraterLake lake;
    const auto base = lattice_triangles(lake.map.geometry, 128, formats);
    const RankTables tables = make_rank_tables(lake.map, base, formats, 12, 0);
    const TexelTable table{tables.rank, tables.columns, tables.rows, formats.texture.fraction};
    const auto mesh_at = [&](std::uint32_t threshold) { return mesh_of(base, table, threshold, formats); };
    struct Row {
        std::size_t triangles;
        double rms;
    };
    for (const Row& row : {Row{2400, 6.85}, Row{4800, 4.6}, Row{9600, 2.95}}) {
        const auto mesh = mesh_at(threshold_for(row.triangles, 4095, mesh_at));
        const QuantisedMap fitted = fit_heights(lake.map, mesh, formats);
        const double rms = lake.metres * error_figures(errors_of(fitted, lake.map, mesh)).rms;
        INFO(mesh.size() << " triangles: " << rms << " m");
        CHECK(rms <= row.rms);
    }
}
