#include "testbench/setup/tables/rank_table.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

#include "modules/datapath/rank_view.h"
#include "testbench/setup/tables/split_hierarchy.h"
#include "testbench/tests/setup/tables/refined_mesh.h"

using namespace tessera;
using namespace tessera::tables_test;

namespace {

const datapath::Formats formats;

TexelTable table_of(const std::vector<std::uint16_t>& entries, const RankTables& tables) {
    return {entries, tables.columns, tables.rows, formats.texture.fraction};
}

/// A map with a lattice over it, clamped (of any size) or repeated (of whole quads).
struct RandomCase {
    QuantisedMap map;
    std::vector<Corners> base;

    explicit RandomCase(Random& random) {
        const std::uint32_t spacing = std::uint32_t{1} << random.natural(1, 6);
        const auto side = [&](AddressMode mode) {
            return mode == AddressMode::repeat ? spacing * random.natural(1, spacing > 16 ? 1 : 3)
                                               : random.natural(2, 40);
        };
        const AddressMode u = random.coin() ? AddressMode::repeat : AddressMode::clamp;
        const AddressMode v = random.coin() ? AddressMode::repeat : AddressMode::clamp;
        const std::uint32_t width = side(u), height = side(v);
        map = random_map(random, width, height, u, v);
        base = lattice_triangles(map.geometry, spacing, formats);
    }
};

/// The mesh of the hierarchy's splits whose entry is above the threshold, made in the host's order.
std::vector<Corners> replay(const SplitHierarchy& hierarchy, std::vector<Corners> mesh, const TexelTable& table,
                            std::uint32_t threshold) {
    for (const EdgeSplit& split : hierarchy.splits) {
        if (table.entries[std::size_t{split.row} * table.columns + split.column] <= threshold)
            continue;
        const std::size_t count = mesh.size();
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const TexCoord a = mesh[i][k], b = mesh[i][(k + 1) % 3], m = middle_of(a, b);
                if (!differs_by_even_texels(a, b, formats) || (m.u >> table.fraction) % table.columns != split.column ||
                    (m.v >> table.fraction) % table.rows != split.row)
                    continue;
                Corners other = mesh[i];
                mesh[i][(k + 1) % 3] = other[k] = m;
                mesh.push_back(other);
                break;
            }
        }
    }
    return mesh;
}

using Sorted = std::multiset<std::array<std::uint32_t, 6>>;
Sorted sorted(const std::vector<Corners>& mesh) {
    Sorted all;
    for (const Corners& t : mesh)
        all.insert({t[0].u, t[0].v, t[1].u, t[1].v, t[2].u, t[2].v});
    return all;
}

/// Number of cases of a random test: `usual`, or TESSERA_TABLE_CASES.
int random_cases(int usual) {
    const char* wanted = std::getenv("TESSERA_TABLE_CASES");
    return wanted == nullptr ? usual : std::stoi(wanted);
}

}  // namespace

TEST_CASE("The hardware's recursion rebuilds the host's hierarchy triangle by triangle") {
    Random random(1);
    for (int trial = 0; trial < 30; ++trial) {
        const RandomCase at(random);
        const int bits = random.integer32(8, 16);
        const SplitHierarchy hierarchy = make_split_hierarchy(at.map, at.base, formats);
        const RankTables tables = make_rank_tables(at.map, at.base, formats, bits, bits);
        REQUIRE(tables.clashes == 0);
        for (const auto* entries : {&tables.rank, &tables.bound}) {
            const TexelTable table = table_of(*entries, tables);
            const std::uint32_t threshold = entries->at(random.bits() % entries->size());
            INFO("trial " << trial << ", " << bits << " bits, threshold " << threshold);
            const bool same = sorted(mesh_of(at.base, table, threshold, formats)) ==
                              sorted(replay(hierarchy, at.base, table, threshold));
            CHECK(same);
        }
    }
}

TEST_CASE("With both tables an edge splits if either requires it, and the rank sets the order") {
    Random random(2);
    for (int trial = 0; trial < 30; ++trial) {
        const RandomCase at(random);
        const RankTables tables = make_rank_tables(at.map, at.base, formats, 12, 10);
        const TexelTable rank = table_of(tables.rank, tables), bound = table_of(tables.bound, tables);
        const std::uint32_t rank_limit = tables.rank[random.bits() % tables.rank.size()];
        const std::uint32_t bound_limit =
            std::min<std::uint32_t>(tables.bound[random.bits() % tables.bound.size()], tables.highest_bound_threshold);
        std::vector<std::uint16_t> either(tables.rank.size(), 0);
        for (std::size_t k = 0; k < either.size(); ++k)
            either[k] = tables.rank[k] > rank_limit || tables.bound[k] > bound_limit ? 1 : 0;
        const auto mesh = refine_all(
            at.base,
            [&](const TexCoord& a, const TexCoord& b) {
                return differs_by_even_texels(a, b, formats) &&
                       (rank.of_edge(a, b) > rank_limit || bound.of_edge(a, b) > bound_limit);
            },
            [&](const TexCoord& a, const TexCoord& b) { return rank.of_edge(a, b); });
        const SplitHierarchy hierarchy = make_split_hierarchy(at.map, at.base, formats);
        const bool same = sorted(mesh) == sorted(replay(hierarchy, at.base, table_of(either, tables), 0));
        CHECK(same);
        CHECK(error_figures(vertical_errors(at.map, mesh, formats.texture.fraction)).largest <=
              std::max(bound_error(bound_limit, 10), tables.least_error) + 1e-6);
    }
}

TEST_CASE("No grid point is beyond the Bound Test's threshold") {
    Random random(3);
    for (int trial = 0; trial < random_cases(300); ++trial) {
        const RandomCase at(random);
        const int bits = random.integer32(6, 16);
        const RankTables tables = make_rank_tables(at.map, at.base, formats, 0, bits);
        const std::uint32_t wanted = bound_threshold(std::exp2(random.real(-2, 16)), bits);
        const std::uint32_t threshold = std::min(wanted, tables.highest_bound_threshold);
        const auto mesh = mesh_of(at.base, table_of(tables.bound, tables), threshold, formats);
        INFO("trial " << trial << ", " << bits << " bits, threshold " << threshold);
        REQUIRE(tables.least_error == 0);
        REQUIRE(count_cracks(mesh, at.map.geometry, formats) == 0);
        REQUIRE(error_figures(vertical_errors(at.map, mesh, formats.texture.fraction)).largest <=
                bound_error(threshold, bits) + 1e-6);
    }
}

TEST_CASE("Off the lattice no grid point is beyond the Bound Test's threshold plus the tables' remainder") {
    Random random(10);
    int with_rest = 0, with_splits = 0;
    for (int trial = 0; trial < random_cases(300); ++trial) {
        RandomCase at(random);
        const std::uint32_t texel = 1u << formats.texture.fraction;
        const std::uint32_t part = random.natural(1, 4);  // quarters of a quad
        const TexCoord shift{random.natural(0, texel), random.natural(0, texel)};
        for (Corners& corners : at.base)
            for (TexCoord& corner : corners)
                corner = {(corner.u - texel / 2) / 4 * part + shift.u, (corner.v - texel / 2) / 4 * part + shift.v};
        const RankTables tables = make_rank_tables(at.map, at.base, formats, 0, 16);
        if (tables.clashes > 0)
            continue;
        const std::uint32_t threshold =
            std::min(bound_threshold(std::exp2(random.real(-2, 16)), 16), tables.highest_bound_threshold);
        const auto mesh = mesh_of(at.base, table_of(tables.bound, tables), threshold, formats);
        INFO("trial " << trial << ", threshold " << threshold);
        REQUIRE(error_figures(vertical_errors(at.map, mesh, formats.texture.fraction)).largest <=
                std::max(bound_error(threshold, 16), tables.least_error) + 1e-6);
        with_rest += tables.least_error > 0 ? 1 : 0;
        with_splits += mesh.size() > at.base.size() ? 1 : 0;
    }
    CHECK(with_rest > 100);
    CHECK(with_splits > 50);
}

namespace {

/// A view of a clamped map; `steps` is the size of texels and codes, in LSB of positions and distances.
struct View {
    SurfaceSteps steps;
    datapath::TransformParameters transform;
    std::array<double, 3> eye{};
    std::array<std::array<double, 3>, 3> axes{};  // right, up, forward
    double focal = 0;
    double half_width = 0, half_height = 0;  // pixels

    View(Random& random, const QuantisedMap& map) {
        steps.u = std::exp2(random.real(8, 14));
        steps.v = steps.u * random.real(0.5, 2);
        steps.code = std::exp2(random.real(-2, 9));
        const auto somewhere = [&] {
            const std::uint32_t column = random.natural(0, map.geometry.width - 1);
            const std::uint32_t row = random.natural(0, map.geometry.height - 1);
            std::array<double, 3> p = place(column + 0.5, row + 0.5, map.code(column, row));
            p[2] += random.real(-0.5, 2) * steps.u;
            return p;
        };
        const std::array<double, 3> at = somewhere(), target = somewhere();
        for (std::size_t k = 0; k < 3; ++k) {
            transform.eye[k] = std::lround(at[k]);
            eye[k] = static_cast<double>(transform.eye[k]);
        }
        axes[2] = unit({target[0] - eye[0] + 1, target[1] - eye[1], target[2] - eye[2]});
        axes[0] = unit(cross(axes[2], {random.real(-0.2, 0.2), 0.1, 1}));
        axes[1] = cross(axes[0], axes[2]);
        focal = std::exp2(random.real(8, 11));
        half_width = random.real(100, 800);
        half_height = random.real(100, 800);
    }

    std::array<double, 3> place(double column, double row, double code) const {
        return {column * steps.u, row * steps.v, code * steps.code};
    }
    std::array<double, 3> seen(const std::array<double, 3>& p) const {
        std::array<double, 3> result{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < 3; ++c)
                result[k] += axes[k][c] * (p[c] - eye[c]);
        return result;
    }
    double secant() const { return std::hypot(1, std::hypot(half_width, half_height) / focal); }

    datapath::ScreenPosition vertex(const QuantisedMap& map, const TexCoord& t, const datapath::Formats& with) const {
        const double texels = std::ldexp(1.0, -with.texture.fraction);
        const auto p = place(t.u * texels, t.v * texels, code_at(map, t, with.texture.fraction));
        const auto rounded = [](double value) { return static_cast<std::int32_t>(std::lround(value)); };
        datapath::ScreenPosition result;
        result.w = rounded(seen(p)[2]);
        result.distance = eye_distance({rounded(p[0]), rounded(p[1]), rounded(p[2])}, transform, with);
        return result;
    }

    /// Largest distance in pixels from a grid point in the picture to the point `errors` codes above or below it.
    double largest_error(const QuantisedMap& map, const std::vector<double>& errors) const {
        double largest = 0;
        for (std::uint32_t row = 0; row < map.geometry.height; ++row) {
            for (std::uint32_t column = 0; column < map.geometry.width; ++column) {
                const double code = map.code(column, row);
                const auto p = seen(place(column + 0.5, row + 0.5, code));
                if (p[2] < 16 || std::abs(p[0]) * focal > half_width * p[2] ||
                    std::abs(p[1]) * focal > half_height * p[2])
                    continue;
                for (const double sign : {-1.0, 1.0}) {
                    const double off = sign * errors[std::size_t{row} * map.geometry.width + column];
                    const auto q = seen(place(column + 0.5, row + 0.5, code + off));
                    const double pixels = focal * std::hypot(q[0] / q[2] - p[0] / p[2], q[1] / q[2] - p[1] / p[2]);
                    largest = std::max(largest, q[2] > 0 ? pixels : 1e9);
                }
            }
        }
        return largest;
    }

  private:
    static std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    static std::array<double, 3> unit(const std::array<double, 3>& v) {
        const double length = std::hypot(v[0], v[1], v[2]);
        return {v[0] / length, v[1] / length, v[2] / length};
    }
};

}  // namespace

TEST_CASE("No grid point in the picture appears farther from the mesh than the bound, and without radii some do") {
    Random random(8);
    datapath::Formats seen = formats;
    seen.height_test = datapath::HeightTest::rank;
    seen.distances = true;
    seen.rank_bits = 0;
    int views = 0, broken_without = 0;
    double nearest = 0;  // largest error, relative to the bound
    for (int trial = 0; trial < random_cases(1200); ++trial) {
        const RandomCase at(random);
        if (at.map.geometry.address_u == AddressMode::repeat || at.map.geometry.address_v == AddressMode::repeat)
            continue;
        const View view(random, at.map);
        seen.bound_bits = random.integer32(8, 16);
        const double rounding = 4 * (1 + 8 * std::sqrt(3.0));
        RankTables tables =
            make_rank_tables(at.map, at.base, seen, 0, seen.bound_bits, RadiusScale{view.steps, rounding});
        const double pixels = std::exp2(random.real(-3, 7));
        datapath::TestParameters parameters;
        parameters.height_thresholds[datapath::bound_number] =
            seen_bound_threshold(pixels, {view.focal, view.secant(), 1, view.steps.code, view.steps.u});
        const auto mesh = [&] {
            const TexelTable bound = table_of(tables.bound, tables);
            return refine_all(
                at.base,
                [&](const TexCoord& a, const TexCoord& b) {
                    if (!differs_by_even_texels(a, b, seen))
                        return false;
                    const std::size_t texel = std::size_t{middle_of(a, b).v >> bound.fraction} * tables.columns +
                                              (middle_of(a, b).u >> bound.fraction);
                    return asks_by_rank({0, tables.bound[texel], tables.radius[texel]},
                                        edge_in_view(view.vertex(at.map, a, seen), view.vertex(at.map, b, seen)),
                                        parameters, seen);
                },
                [&](const TexCoord& a, const TexCoord& b) { return bound.of_edge(a, b); });
        };
        const auto with = mesh();
        INFO("trial " << trial << ", " << seen.bound_bits << " bits, " << pixels << " pixels");
        REQUIRE(count_cracks(with, at.map.geometry, seen) == 0);
        const double largest = view.largest_error(at.map, vertical_errors(at.map, with, seen.texture.fraction));
        REQUIRE(largest <= pixels);
        nearest = std::max(nearest, largest / pixels);
        views += largest > 0 ? 1 : 0;
        std::fill(tables.radius.begin(), tables.radius.end(), std::uint8_t{0});
        const auto without = mesh();
        REQUIRE(count_cracks(without, at.map.geometry, seen) == 0);
        broken_without +=
            view.largest_error(at.map, vertical_errors(at.map, without, seen.texture.fraction)) > pixels ? 1 : 0;
    }
    CHECK(views > 30);
    CHECK(nearest > 0.5);
    CHECK(broken_without > 0);
}

TEST_CASE("Radii nest: a midpoint's radius covers those of all midpoints that need it, from its edge's ends") {
    Random random(9);
    std::size_t raised = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const RandomCase at(random);
        const SurfaceSteps steps{random.real(100, 1000), random.real(100, 1000), std::exp2(random.real(-4, 8))};
        const double rounding = random.real(0, 50);
        const RankTables tables = make_rank_tables(at.map, at.base, formats, 0, 12, RadiusScale{steps, rounding});
        const SplitHierarchy hierarchy = make_split_hierarchy(at.map, at.base, formats, steps);
        REQUIRE(tables.clashes == 0);
        const auto radius = [&](std::size_t split) {
            const EdgeSplit& its = hierarchy.splits[split];
            return static_cast<double>(
                datapath::midpoint_radius(tables.radius[std::size_t{its.row} * tables.columns + its.column]));
        };
        for (std::size_t k = 0; k < hierarchy.splits.size(); ++k)
            REQUIRE(radius(k) >= hierarchy.splits[k].reach + rounding);
        for (const SplitDependency& dependency : hierarchy.dependencies) {
            REQUIRE(radius(dependency.maker) >= radius(dependency.split) + dependency.apart + rounding);
            raised += radius(dependency.maker) > 1.2 * (hierarchy.splits[dependency.maker].reach + rounding) ? 1u : 0u;
        }
    }
    CHECK(raised > 0);
}

TEST_CASE("Thresholds as seen: twice the distance, or half the picture, is one octave") {
    const ViewedScale view{512, 1, 1, 1, 2};
    const auto rank = [&](double error, bool per_pixel) { return seen_rank_threshold(error, per_pixel, view); };
    // An error of 1 code at distance 1 (sum of two distances: 2) is 512 pixels high; a texel is 1024 pixels wide.
    CHECK(rank(512, false) == (16 - 2) << 10);
    CHECK(rank(1024, false) == 16 << 10);
    CHECK(rank(512 * 1024, true) == (16 - 4) << 10);
    CHECK(seen_rank_threshold(512, false, {1024, 1, 1, 1, 2}) == (16 - 4) << 10);
    CHECK(rank(0, false) == -(1 << (datapath::rank_limit_bits - 1)));
    CHECK(seen_rank_threshold(1, true, {512, 1, 1, 0, 2}) == (1 << (datapath::rank_limit_bits - 1)) - 1);
    CHECK(seen_rank_threshold(0, true, {512, 1, 1, 0, 2}) == -(1 << (datapath::rank_limit_bits - 1)));
    CHECK(seen_bound_threshold(512, view) == (8 - 2) << 11);  // 512 of 512 + 512 pixels, and the sum of two distances
    CHECK(seen_bound_threshold(0, view) == -(1 << (datapath::bound_limit_bits - 1)));
    CHECK(seen_bound_threshold(1, {512, 1, 1, 0, 2}) == (1 << (datapath::bound_limit_bits - 1)) - 1);
}

TEST_CASE("Entries of too few bits keep the order, and the bound holds up to a reported threshold") {
    Random random(6);
    QuantisedMap map = empty_map(97, 97, AddressMode::clamp, AddressMode::clamp);
    for (std::uint16_t& code : map.codes)
        code = static_cast<std::uint16_t>(random.natural(0, 65535));
    const auto base = lattice_triangles(map.geometry, 64, formats);
    const SplitHierarchy hierarchy = make_split_hierarchy(map, base, formats);
    const RankTables tables = make_rank_tables(map, base, formats, 6, 6);
    CHECK(tables.highest_bound_threshold < 63);
    for (const auto* entries : {&tables.rank, &tables.bound}) {
        CHECK(*std::max_element(entries->begin(), entries->end()) == 63);
        const TexelTable table = table_of(*entries, tables);
        for (const std::uint32_t threshold : {50u, 59u, 62u}) {
            INFO("threshold " << threshold);
            const auto mesh = mesh_of(base, table, threshold, formats);
            const bool same = sorted(mesh) == sorted(replay(hierarchy, base, table, threshold));
            CHECK(same);
        }
    }
    const auto largest_at = [&](std::uint32_t threshold) {
        const auto mesh = mesh_of(base, table_of(tables.bound, tables), threshold, formats);
        return error_figures(vertical_errors(map, mesh, formats.texture.fraction)).largest;
    };
    const std::uint32_t highest = tables.highest_bound_threshold;
    CHECK(largest_at(highest) <= bound_error(highest, 6));
    CHECK(largest_at(highest + 1) > bound_error(highest + 1, 6));
}

TEST_CASE("Tables of random bits give meshes without cracks") {
    Random random(4);
    for (int trial = 0; trial < 100; ++trial) {
        const RandomCase at(random);
        RankTables tables = make_rank_tables(at.map, at.base, formats, 8, 0);
        for (std::uint16_t& entry : tables.rank)
            entry = static_cast<std::uint16_t>(random.natural(0, 3));
        const auto mesh = mesh_of(at.base, table_of(tables.rank, tables), random.natural(0, 2), formats);
        REQUIRE(count_cracks(mesh, at.map.geometry, formats) == 0);
    }
}

TEST_CASE("Triangles without area in the map are not in the hierarchy") {
    const std::uint32_t texel = 1u << formats.texture.fraction;
    Random random(7);
    const QuantisedMap map = random_map(random, 4, 4, AddressMode::clamp, AddressMode::clamp);
    const std::vector<Corners> base{Corners{TexCoord{0, 0}, TexCoord{2 * texel, 0}, TexCoord{3 * texel, 0}}};
    const RankTables tables = make_rank_tables(map, base, formats, 8, 8);
    CHECK(tables.least_error == 0);
    CHECK(*std::max_element(tables.bound.begin(), tables.bound.end()) == 0);
}

TEST_CASE("Thresholds are rounded down to entries, and entries convert to the error they guarantee") {
    for (int bits = 6; bits <= 16; ++bits) {
        CHECK(bound_error(bound_threshold(100, bits), bits) <= 100 * (1 + 1e-12));
        CHECK(bound_error(bound_threshold(100, bits) + 1, bits) > 100 * (1 + 1e-12));
        CHECK(bound_threshold(1, bits) == 8u << (bits - 5));
        CHECK(rank_threshold(1, bits) == 16u << (bits - 6));
        CHECK(rank_threshold(2, bits) == 18u << (bits - 6));
        CHECK(rank_threshold(0, bits) == 0);
        CHECK(bound_threshold(1e30, bits) == (1u << bits) - 1);
    }
}

TEST_CASE("Any base mesh gets tables as far as its edges allow") {
    const std::uint32_t texel = 1u << formats.texture.fraction;
    const auto triangle = [&](std::array<double, 6> t) {
        const auto at = [&](std::size_t k) { return static_cast<std::uint32_t>(t[k] * texel); };
        return Corners{TexCoord{at(0), at(1)}, TexCoord{at(2), at(3)}, TexCoord{at(4), at(5)}};
    };
    Random random(5);
    const QuantisedMap map = random_map(random, 32, 32, AddressMode::clamp, AddressMode::clamp);

    SECTION("edges whose ends are not an even number of texels apart never split") {
        const std::vector<Corners> base{triangle({0.5, 0.5, 31.5, 0.5, 31.5, 31.5}),
                                        triangle({0.5, 0.5, 31.5, 31.5, 0.5, 31.5})};
        CHECK(count_whole_base_edges(base, formats) == 5);
        const RankTables tables = make_rank_tables(map, base, formats, 8, 8);
        CHECK(std::count(tables.rank.begin(), tables.rank.end(), 0) == 32 * 32);
        CHECK(tables.least_error > 0);
        CHECK(tables.least_error ==
              Approx(error_figures(vertical_errors(map, base, formats.texture.fraction)).largest));
    }
    SECTION("beyond a clamped map the table is larger than the map") {
        const std::vector<Corners> base{triangle({0.5, 0.5, 64.5, 0.5, 0.5, 32.5})};
        const RankTables tables = make_rank_tables(map, base, formats, 8, 0);
        CHECK(tables.columns == 65);
        CHECK(tables.rows == 33);
        CHECK(count_whole_base_edges(base, formats) == 0);
    }
    SECTION("a midpoint of triangles on the same texels has the greater entry") {
        std::vector<Corners> base{triangle({0.5, 0.5, 32.5, 0.5, 32.5, 32.5}),
                                  triangle({0.5, 0.5, 32.5, 32.5, 0.5, 32.5})};
        const RankTables alone = make_rank_tables(map, base, formats, 0, 8);
        base.push_back(base.front());
        CHECK(make_rank_tables(map, base, formats, 0, 8).bound == alone.bound);
        base.back() = triangle({8.25, 8.25, 24.25, 8.25, 8.25, 24.25});
        const RankTables both = make_rank_tables(map, base, formats, 0, 8);
        CHECK(both.clashes > 0);
        for (std::size_t k = 0; k < both.bound.size(); ++k)
            CHECK(both.bound[k] >= alone.bound[k]);
    }
    SECTION("a cylinder twice around the map has the table of one") {
        QuantisedMap around = random_map(random, 32, 20, AddressMode::repeat, AddressMode::clamp);
        const auto once = lattice_triangles(around.geometry, 16, formats);
        auto twice = once;
        for (Corners corners : once) {
            for (TexCoord& corner : corners)
                corner.u += 32 * texel;
            twice.push_back(corners);
        }
        const RankTables tables = make_rank_tables(around, twice, formats, 10, 10);
        CHECK(tables.columns == 32);
        CHECK(tables.rank == make_rank_tables(around, once, formats, 10, 0).rank);
        const auto mesh = mesh_of(twice, table_of(tables.bound, tables), bound_threshold(500, 10), formats);
        CHECK(error_figures(vertical_errors(around, mesh, formats.texture.fraction)).largest <= 500);
    }
}

TEST_CASE("Crater Lake from 24 triangles, RMS and largest error in metres") {
    const CraterLake lake;
    const auto base = lattice_triangles(lake.map.geometry, 128, formats);
    REQUIRE(base.size() == 24);
    const RankTables tables = make_rank_tables(lake.map, base, formats, 16, 16);
    REQUIRE(tables.least_error == 0);
    struct Row {
        std::size_t triangles;
        double rank_rms, bound_rms, bound_largest;
    };
    for (const Row& row : {Row{1200, 11.6, 16.0, 60}, Row{2400, 7.9, 10.9, 39.5}, Row{4800, 5.35, 7.3, 25.5},
                           Row{9600, 3.5, 4.45, 15.5}, Row{19200, 2.12, 2.6, 8.5}}) {
        const auto figures_of = [&](const std::vector<std::uint16_t>& entries) {
            const auto mesh_at = [&](std::uint32_t threshold) {
                return mesh_of(base, table_of(entries, tables), threshold, formats);
            };
            const auto mesh = mesh_at(threshold_for(row.triangles, 65535, mesh_at));
            return error_figures(vertical_errors(lake.map, mesh, formats.texture.fraction));
        };
        const ErrorFigures rank = figures_of(tables.rank), bound = figures_of(tables.bound);
        INFO(row.triangles << " triangles: rank " << rank.rms * lake.metres << " m, bound " << bound.rms * lake.metres
                           << " m, largest " << bound.largest * lake.metres << " m");
        CHECK(rank.rms * lake.metres <= row.rank_rms);
        CHECK(bound.rms * lake.metres <= row.bound_rms);
        CHECK(bound.largest * lake.metres <= row.bound_largest);
    }
}
