#include "testbench/setup/tables/fitted_heights.h"

#include <catch2/catch.hpp>

#include "testbench/setup/tables/rank_table.h"
#include "testbench/tests/setup/tables/refined_mesh.h"

using namespace tessera;
using namespace tessera::tables_test;

namespace {

const datapath::Formats formats;

/// Texels as wide as 100 codes are high: steep slopes.
QuantisedMap fit(const QuantisedMap& map, const std::vector<Corners>& mesh) {
    return fit_heights(map, [&](const QuantisedMap&) { return mesh; }, formats, {100, 100});
}

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
    const QuantisedMap fitted = fit(map, mesh);
    for (std::uint32_t y = 0; y < 65; ++y) {
        for (std::uint32_t x = 0; x < 65; ++x)
            if (x % 32 == 0 && y % 32 == 0)
                CHECK(fitted.code(x, y) == Approx(level(x, y)).margin(120));
            else
                REQUIRE(fitted.code(x, y) == map.code(x, y));
    }
}

TEST_CASE("No other code under a vertex reduces the squared error, in which its own counts as one more point") {
    Random random(2);
    for (int trial = 0; trial < 10; ++trial) {
        // Only texels under vertices and beside them are not level: fitting reduces the error nearly everywhere.
        QuantisedMap map = empty_map(25, 17, AddressMode::clamp, AddressMode::clamp);
        for (std::uint32_t k = 0; k < map.codes.size(); ++k) {
            const std::uint32_t x = k % 25, y = k / 25;
            const int vertex = x % 8 == 0 && y % 8 == 0 ? random.integer32(200, 400) : 0;
            const int beside = x % 8 == 1 && y % 8 == 0 ? random.integer32(-900, -700) : 0;
            map.codes[k] = static_cast<std::uint16_t>(30000 + vertex + beside);
        }
        const auto mesh = lattice_triangles(map.geometry, 8, formats);
        QuantisedMap fitted = fit(map, mesh);
        const auto cost = [&] {
            double sum = squared(errors_of(fitted, map, mesh));
            for (std::size_t k = 0; k < map.codes.size(); ++k)
                sum += (fitted.codes[k] - map.codes[k]) * (fitted.codes[k] - map.codes[k]);
            return sum;
        };
        const double least = cost();
        CHECK(least < squared(errors_of(map, map, mesh)) / 2);
        for (std::uint32_t y = 0; y < 17; y += 8)
            for (std::uint32_t x = 0; x < 25; x += 8) {
                std::uint16_t& code = fitted.codes[std::size_t{y} * 25 + x];
                for (const int change : {-3, 3}) {
                    code = static_cast<std::uint16_t>(code + change);
                    CHECK(cost() > least);
                    code = static_cast<std::uint16_t>(code - change);
                }
            }
    }
}

TEST_CASE("Between slivers, heights stay among those around them, and the squared error does not rise") {
    Random random(4);
    for (int trial = 0; trial < 4; ++trial) {
        QuantisedMap map = empty_map(48, 48, AddressMode::clamp, AddressMode::clamp);
        const int cliff = random.integer32(10, 38);
        for (std::uint32_t k = 0; k < map.codes.size(); ++k)
            map.codes[k] = static_cast<std::uint16_t>((static_cast<int>(k % 48) < cliff ? 20000 : 40000) +
                                                      random.integer32(-300, 300));
        // Fans of slivers from random points: few texel centres lie in each.
        std::vector<Corners> mesh;
        const auto point = [&](std::uint32_t x, std::uint32_t y) { return TexCoord{x << 6, y << 6}; };
        for (std::uint32_t fan = 0; fan < 48 * 64; fan += 16 * 64) {
            const TexCoord apex = point(fan + random.natural(0, 1023), random.natural(0, 3071));
            for (std::uint32_t x = 0; x < 3072; x += 48) {
                mesh.push_back({apex, point(x, 0), point(x + 48, 0)});
                mesh.push_back({apex, point(x + 48, 3072), point(x, 3072)});
            }
        }
        const QuantisedMap fitted = fit(map, mesh);
        for (std::uint32_t y = 0; y < 48; ++y)
            for (std::uint32_t x = 0; x < 48; ++x) {
                std::uint16_t low = 0xffff, high = 0;
                for (std::uint32_t row = y < 2 ? 0 : y - 2; row <= std::min(y + 2, 47U); ++row)
                    for (std::uint32_t column = x < 2 ? 0 : x - 2; column <= std::min(x + 2, 47U); ++column) {
                        low = std::min(low, map.code(column, row));
                        high = std::max(high, map.code(column, row));
                    }
                REQUIRE(fitted.code(x, y) >= low);
                REQUIRE(fitted.code(x, y) <= high);
            }
        CHECK(squared(errors_of(fitted, map, mesh)) <= squared(errors_of(map, map, mesh)));
    }
}

TEST_CASE("A mesh that no other heights improve keeps its own") {
    QuantisedMap map = empty_map(33, 33, AddressMode::clamp, AddressMode::clamp);
    for (std::uint32_t k = 0; k < map.codes.size(); ++k)
        map.codes[k] = static_cast<std::uint16_t>(1000 + 40 * (k % 33) + 70 * (k / 33));
    CHECK(fit(map, lattice_triangles(map.geometry, 16, formats)).codes == map.codes);
}

TEST_CASE("No fitted mesh lies farther from the map than that of the map's own heights") {
    const auto noise = [](Random& random, std::uint32_t low, std::uint32_t high) {
        QuantisedMap map = empty_map(33, 33, AddressMode::clamp, AddressMode::clamp);
        for (std::uint16_t& code : map.codes)
            code = static_cast<std::uint16_t>(random.natural(low, high));
        return map;
    };
    Random random(6);
    for (int trial = 0; trial < 20; ++trial) {
        const QuantisedMap map = noise(random, 29000, 31000);
        const auto mesh = lattice_triangles(map.geometry, 16, formats);
        // Texels so wide that a vertical error is the distance.
        const QuantisedMap fitted = fit_heights(map, [&](const QuantisedMap&) { return mesh; }, formats, {1e4, 1e4});
        const auto own = error_figures(errors_of(map, map, mesh)), now = error_figures(errors_of(fitted, map, mesh));
        CHECK(now.largest <= own.largest);
        CHECK(now.rms <= own.rms);
    }
    INFO("steep noise: only the vertical error would fall");
    const QuantisedMap steep = noise(random, 20000, 40000);
    CHECK(fit(steep, lattice_triangles(steep.geometry, 16, formats)).codes == steep.codes);
}

TEST_CASE("Each of several meshes over the same texels counts") {
    Random random(3);
    QuantisedMap map = empty_map(33, 33, AddressMode::clamp, AddressMode::clamp);
    // A ridge, for which the coarse mesh needs higher corners than the fine one; the texels beside them are far off.
    for (std::uint32_t k = 0; k < map.codes.size(); ++k) {
        const std::uint32_t x = k % 33, y = k / 33;
        const int ridge = 20 * static_cast<int>(16 - tables_test::distance(x, 16));
        const int beside = x % 16 == 1 && y % 16 == 0 ? 1000 : 0;
        map.codes[k] = static_cast<std::uint16_t>(30000 + ridge + beside + random.integer32(-5, 5));
    }
    const auto coarse = lattice_triangles(map.geometry, 32, formats);
    const auto fine = lattice_triangles(map.geometry, 16, formats);
    auto both = coarse;
    both.insert(both.end(), fine.begin(), fine.end());
    const auto of_both = [&](const QuantisedMap& heights) {
        return squared(errors_of(heights, map, coarse)) + squared(errors_of(heights, map, fine));
    };
    const double together = of_both(fit(map, both));
    CHECK(together < 0.999 * of_both(fit(map, coarse)));
    CHECK(together < 0.999 * of_both(fit(map, fine)));
}

TEST_CASE("Fitted heights stay within the range of codes") {
    QuantisedMap map = empty_map(17, 17, AddressMode::clamp, AddressMode::clamp);
    map.bits = 10;
    for (std::uint32_t k = 0; k < map.codes.size(); ++k)
        map.codes[k] = k % 17 < 8 ? 0 : 1023;
    const QuantisedMap fitted = fit(map, lattice_triangles(map.geometry, 16, formats));
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
    for (const Row& row : {Row{2400, 6.95}, Row{4800, 4.6}, Row{9600, 3}}) {
        const auto mesh = mesh_at(threshold_for(row.triangles, 4095, mesh_at));
        const double texel = 30 / lake.metres;  // of 30 m
        const QuantisedMap fitted =
            fit_heights(lake.map, [&](const QuantisedMap&) { return mesh; }, formats, {texel, texel});
        const double rms = lake.metres * error_figures(errors_of(fitted, lake.map, mesh)).rms;
        INFO(mesh.size() << " triangles: " << rms << " m");
        CHECK(rms <= row.rms);
    }
}
