// The height map, its summed-area table and its normals, and displaced vertices.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "golden/golden_model.h"
#include "golden/height_tests/curvature_test.h"
#include "golden/height_tests/mipmap_test.h"
#include "testbench/tests/golden/golden_cases.h"

using namespace tessera::golden;
using namespace tessera::golden::testing;

TEST_CASE("table: four reads give the sum of the texels") {
    Random random;
    for (const auto& [width, height] : sizes) {
        for (const bool constant : {true, false}) {
            const Map map(width, height, AddressMode::repeat, AddressMode::repeat,
                          constant ? constant_codes(width, height, 65535) : random_codes(width, height, random));
            const auto check = [&, w = width, h = height](const Rectangle& r) {
                const std::uint64_t sum = map.sum(r), expected = map.brute_force_sum(r);
                if (sum != expected) {
                    FAIL(w << "x" << h << " map, rectangle at " << r.x << "," << r.y << " of " << r.width << "x"
                           << r.height << ": table " << sum << ", brute force " << expected);
                }
            };
            if (width * height < 1000) {
                // Every origin in three periods, every size up to two.
                for (std::int64_t y = -height; y < 2 * height; ++y) {
                    for (std::int64_t x = -width; x < 2 * width; ++x) {
                        for (std::int64_t h = 1; h <= height + 1; ++h)
                            for (std::int64_t w = 1; w <= width + 1; ++w)
                                check({x, y, w, h});
                    }
                }
            } else {
                for (int k = 0; k < 400; ++k) {
                    check({random.integer(-1000, 1000), random.integer(-1000, 1000), random.integer(1, width),
                           random.integer(1, height)});
                }
                check({0, 0, width, height});
                check({-5 * width + 7, 4 * height - 3, 2 * width + 1, 2 * height + 1});
            }
        }
    }
}

TEST_CASE("map: unusable input is refused") {
    const AddressMode clamp = AddressMode::clamp;
    CHECK_THROWS_AS(Map(0, 1, clamp, clamp, {}), std::invalid_argument);
    CHECK_THROWS_AS(Map(1, 0, clamp, clamp, {}), std::invalid_argument);
    CHECK_THROWS_AS(Map(2, 2, clamp, clamp, {1, 2, 3}), std::invalid_argument);
    CHECK_THROWS_AS(Map(1, 1, clamp, clamp, {0.5}), std::invalid_argument);
    CHECK_THROWS_AS(Map(1, 1, clamp, clamp, {-1}), std::invalid_argument);
    CHECK_THROWS_AS(Map(1, 1, clamp, clamp, {std::nan("")}), std::invalid_argument);
    CHECK_THROWS_AS(Map(1, 1, clamp, clamp, {0x1p52}), std::invalid_argument);
    const std::vector<double> highest(1025 * 1024, 0x1p32 - 1);  // their sum is above 2^52, that of 1024 rows is not
    CHECK_THROWS_AS(Map(1025, 1024, clamp, clamp, highest), std::invalid_argument);
    CHECK_NOTHROW(Map(1024, 1024, clamp, clamp, {highest.begin(), highest.begin() + 1024 * 1024}));
    Map map(1, 2, clamp, clamp, {1, 2});
    CHECK_THROWS_AS(map.set_normals({{0, 0, 1}}), std::invalid_argument);
}

TEST_CASE("map: the nearest texel is read at borders and over any number of periods") {
    Random random;
    const Map clamped(5, 3, AddressMode::clamp, AddressMode::clamp, random_codes(5, 3, random));
    const Map repeated(5, 3, AddressMode::repeat, AddressMode::repeat, random_codes(5, 3, random));
    CHECK(clamped.texel({0, 0}) == 0);
    CHECK(clamped.texel({4.9, 2.9}) == 14);
    CHECK(clamped.texel({5, 3}) == 14);  // last border: last texel
    CHECK(clamped.texel({-3.5, 99}) == 10);
    CHECK(repeated.texel({5, 3}) == 0);  // last border: first texel
    CHECK(repeated.texel({-0.25, -0.25}) == 14);
    for (int period = -4; period <= 4; ++period)
        CHECK(repeated.texel({5 * period + 2.5, 1.5 - 3 * period}) == 7);
    const Map mixed(5, 3, AddressMode::repeat, AddressMode::clamp, random_codes(5, 3, random));
    CHECK(mixed.texel({5, 3}) == 10);
}

TEST_CASE("map: four texels are interpolated, at borders and over any number of periods") {
    const Filter filter = Filter::bilinear;
    const std::vector<double> codes{10, 20, 60, 30, 50, 10};  // 3 x 2
    const Map clamped(3, 2, AddressMode::clamp, AddressMode::clamp, codes);
    const Map repeated(3, 2, AddressMode::repeat, AddressMode::repeat, codes);
    for (std::size_t texel = 0; texel < 6; ++texel) {
        const glm::dvec2 centre(0.5 + static_cast<double>(texel % 3), 0.5 + static_cast<double>(texel / 3));
        CHECK(clamped.code(centre, filter) == codes[texel]);
        CHECK(repeated.code(centre, filter) == codes[texel]);
    }
    CHECK(clamped.code({0.75, 0.5}, filter) == 12.5);
    CHECK(clamped.code({1, 0.75}, filter) == 0.75 * 15 + 0.25 * 40);
    CHECK(clamped.code({0, 0}, filter) == 10);
    CHECK(clamped.code({3, 2}, filter) == 10);
    CHECK(clamped.code({3, 1}, filter) == 35);
    CHECK(repeated.code({0, 0.5}, filter) == 35);
    CHECK(repeated.code({3, 0.5}, filter) == 35);
    CHECK(repeated.code({0, 0}, filter) == (10 + 60 + 30 + 10) / 4.0);
    for (int period = -4; period <= 4; ++period)
        CHECK(repeated.code({3 * period + 0.75, 0.5 - 2 * period}, filter) == 12.5);
    CHECK(clamped.code({1.9, 0.2}, Filter::nearest) == 20);
}

TEST_CASE("map: normals between texels are weighted and not normalised") {
    Map map(2, 1, AddressMode::clamp, AddressMode::clamp, {0, 0});
    map.set_normals({{1, 0, 0}, {0, 0, 1}});
    CHECK(map.normal({1, 0.5}, Filter::bilinear) == glm::dvec3(0.5, 0, 0.5));
    CHECK(map.normal({0.75, 0.25}, Filter::bilinear) == glm::dvec3(0.75, 0, 0.25));
    CHECK(map.normal({1, 0.5}, Filter::nearest) == glm::dvec3(0, 0, 1));
}

TEST_CASE("map: the rectangles of the Summed Height Test are those worked out by hand") {
    const auto same = [](const Rectangle& r, std::int64_t x, std::int64_t y, std::int64_t w, std::int64_t h) {
        return r.x == x && r.y == y && r.width == w && r.height == h;
    };
    const Map clamped(32, 16, AddressMode::clamp, AddressMode::clamp, constant_codes(32, 16, 0));
    const Map repeated(32, 16, AddressMode::repeat, AddressMode::repeat, constant_codes(32, 16, 0));

    CHECK(same(clamped.rectangle_size({10, 4}, {18, 12}), 0, 0, 4, 2));
    CHECK(same(clamped.rectangle_size({18, 12}, {10, 4}), 0, 0, 4, 2));
    CHECK(same(clamped.rectangle_size({3, 3}, {3, 3}), 0, 0, 1, 1));         // never empty
    CHECK(same(clamped.rectangle_size({0, 0}, {5.99, 11.99}), 0, 0, 2, 2));  // whole texels, downwards
    CHECK(same(repeated.rectangle_size({0, 0}, {320, 160}), 0, 0, 32, 16));  // never wider than the map
    CHECK(same(clamped.rectangle_size({0, 0}, {320, 160}), 0, 0, 32, 16));

    const Rectangle size{0, 0, 4, 3};
    INFO("each axis follows its own address mode");
    const Map clamped_u(32, 16, AddressMode::clamp, AddressMode::repeat, constant_codes(32, 16, 0));
    const Map clamped_v(32, 16, AddressMode::repeat, AddressMode::clamp, constant_codes(32, 16, 0));
    for (const Map* map : {&clamped_u, &clamped_v})
        CHECK(same(map->rectangle_size({0, 0}, {320, 160}), 0, 0, 32, 16));
    CHECK(same(clamped_u.rectangle_about({0.5, 0.5}, size), 0, 15, 4, 3));
    CHECK(same(clamped_v.rectangle_about({0.5, 0.5}, size), 30, 0, 4, 3));
    CHECK(same(clamped_u.rectangle_about({32, 16}, size), 28, 15, 4, 3));
    CHECK(same(clamped_v.rectangle_about({32, 16}, size), 30, 13, 4, 3));
    CHECK(same(clamped.rectangle_about({10.7, 8.2}, size), 8, 7, 4, 3));
    CHECK(same(repeated.rectangle_about({10.7, 8.2}, size), 8, 7, 4, 3));
    CHECK(same(clamped.rectangle_about({0.5, 0.5}, size), 0, 0, 4, 3));  // shifted inside, not clipped
    CHECK(same(clamped.rectangle_about({32, 16}, size), 28, 13, 4, 3));
    CHECK(same(repeated.rectangle_about({0.5, 0.5}, size), 30, 15, 4, 3));  // read periodically
    CHECK(same(repeated.rectangle_about({32, 16}, size), 30, 15, 4, 3));    // the seam's other copy
    CHECK(same(repeated.rectangle_about({-95.5, 16.5}, size), 30, 15, 4, 3));
}

TEST_CASE("map: the Curvature Table's nearest cell is read at each level, the higher of two") {
    Map map(21, 13, AddressMode::clamp, AddressMode::repeat, std::vector<double>(std::size_t{21} * 13, 0));
    // Levels 2 to 5, with cells every 2, 4, 8, 16 texels up to the nearest to texels 20 and 12; each holds its number.
    const std::vector<std::array<int, 2>> cells = {{11, 7}, {6, 4}, {4, 3}, {2, 2}};
    CurvatureTable table{21, 13, {}};
    for (const auto& [columns, rows] : cells)
        for (int k = 0; k < columns * rows; ++k)
            table.cells.push_back({static_cast<double>(table.cells.size()), 0, 0, 0, 1});
    const CurvatureTest test(table, 0);
    int first = 0;
    for (int level = 2; level <= 5; ++level) {
        const auto [columns, rows] = cells[static_cast<std::size_t>(level - 2)];
        const int spacing = 1 << (level - 1);
        const auto nearest = [&](int texel) {
            return static_cast<int>(std::floor(texel / static_cast<double>(spacing) + 0.5));
        };
        for (int y = 0; y < 26; ++y)
            for (int x = 0; x < 30; ++x) {
                const int cell = first + nearest(y % 13) * columns + nearest(std::min(x, 20));
                CHECK(test.cell({x + 0.9, y + 0.1}, level, map).xx == cell);
            }
        first += columns * rows;
    }
    CHECK(test.cell({3, 3}, 9, map).xx == test.cell({3, 3}, 5, map).xx);
}

TEST_CASE("map: other heights replace the displacement map and nothing else") {
    const std::vector<double> codes{1, 2, 9, 4, 4, 6};
    Map map(3, 2, AddressMode::clamp, AddressMode::clamp, codes);
    map.derive_normals(0.1, {1, 1});
    const glm::dvec3 normal = map.normal(4);
    map.set_heights({7, 2, 9, 4, 0, 6});
    CHECK(map.code(0) == 7);
    CHECK(map.code({1.5, 1.5}, Filter::nearest) == 0);
    CHECK(map.normal(4) == normal);
    CHECK(map.sum({0, 0, 3, 2}) == 26);
    CHECK_THROWS_AS(map.set_heights({1}), std::invalid_argument);
}

TEST_CASE("map: a mipmap's blocks, clipped at the border, hold means rounded to nearest, or maxima") {
    Map map(3, 2, AddressMode::clamp, AddressMode::repeat, {1, 2, 9, 4, 4, 6});
    const MipmapTest means(map, MipmapFilter::mean, 0);
    using Levels = MipmapTest::Levels;
    CHECK(means.levels() == Levels{{1, 2, 9, 4, 4, 6}, {3, 8}, {4}});  // 11/4, 15/2 upwards, 26/6
    CHECK(means.height({5, 2.5}, 0, map) == 9);
    CHECK(means.height({1.9, 1}, 1, map) == 3);
    CHECK(means.height({2, 3}, 1, map) == 8);
    CHECK(MipmapTest(map, MipmapFilter::maximum, 0).levels() == Levels{{1, 2, 9, 4, 4, 6}, {4, 9}, {9}});
}

TEST_CASE("normal map: normals are central differences, also at borders and on thin axes") {
    const double scale = 0.01, su = 0.5, sv = 0.25;
    const auto expected = [&](double du, double dv) {
        const glm::dvec3 n(-du, -dv, 1);
        return n / glm::length(n);
    };
    std::vector<double> ramp;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            ramp.push_back(10 * x + 30 * y);
    Map clamped(5, 4, AddressMode::clamp, AddressMode::clamp, ramp);
    clamped.derive_normals(scale, {su, sv});
    for (std::size_t texel = 0; texel < 20; ++texel)  // a ramp's one-sided slope at the border is its slope
        CHECK(glm::distance(clamped.normal(texel), expected(10 * scale / su, 30 * scale / sv)) < 1e-15);
    Map repeated(5, 4, AddressMode::repeat, AddressMode::repeat, ramp);
    repeated.derive_normals(scale, {su, sv});
    CHECK(glm::distance(repeated.normal(6), expected(10 * scale / su, 30 * scale / sv)) < 1e-15);
    CHECK(glm::distance(repeated.normal(0), expected((10 - 40) / 2.0 * scale / su, (30 - 90) / 2.0 * scale / sv)) <
          1e-15);
    for (const AddressMode mode : both_modes) {
        Map thin(1, 3, mode, AddressMode::clamp, {0, 7, 20});
        thin.derive_normals(scale, {su, sv});
        CHECK(glm::distance(thin.normal(0), expected(0, 7 * scale / sv)) < 1e-15);
        CHECK(glm::distance(thin.normal(1), expected(0, 10 * scale / sv)) < 1e-15);
        CHECK(glm::distance(thin.normal(2), expected(0, 13 * scale / sv)) < 1e-15);
    }
}

TEST_CASE("bump: a flat normal map returns the normal, others follow axes and handedness") {
    Random random;
    for (int k = 0; k < 1000; ++k) {
        const glm::dvec3 n = random.unit(), t = random.unit();
        const Normalised flat = bump(n, t, 1, {0, 0, 1});
        REQUIRE(glm::distance(flat.direction, n) < 1e-15);
        REQUIRE(flat.length == Approx(1));
    }
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    CHECK(bump(z, x, 1, x).direction == x);
    CHECK(bump(z, x, 1, y).direction == y);
    CHECK(bump(z, x, -1, y).direction == -y);
    CHECK(normalise({0, 0, 0}).direction == glm::dvec3(0));
    CHECK(normalise({3, 0, 4}).length == 5);
}

TEST_CASE("vertex: displaced, inserted and transformed as in ALGORITHM.md section 3") {
    Map map(4, 4, AddressMode::clamp, AddressMode::clamp, {0, 0, 0, 0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0, 300});
    Parameters p;
    p.scale = 0.5;
    p.bias = -2;
    p.row_x = {100, 0, 0, 0};
    p.row_y = {0, 50, 0, 10};
    p.row_w = {0, 0, 1, 2};
    p.near_plane = 1;
    Vertex a, b;
    a.position = {1, 2, 3};
    a.normal = {0, 0, 1};
    a.tangent = {1, 0, 0};
    a.texture = {4, 4};
    b = a;
    b.position = {3, 2, 3};
    b.normal = {0, 1, 0};
    b.texture = {0.5, -1};
    a = complete_base_vertex(a, map, p);
    b = complete_base_vertex(b, map, p);
    CHECK(a.displaced_position == glm::dvec3(1, 2, 3 + 148));
    CHECK(b.displaced_position == glm::dvec3(3, 0, 3));
    CHECK(a.w == 153);
    CHECK(b.screen == glm::dvec2(60, 2));
    CHECK(b.in_front);

    b.generation = 4;
    const Insertion m = insert_vertex(a, b, map, p);
    CHECK(m.vertex.texture == glm::dvec2(2.25, 1.5));
    CHECK(m.vertex.generation == 5);
    CHECK(m.mean_normal_length == Approx(std::sqrt(0.5)));
    CHECK(m.mean_tangent_length == 1);
    const glm::dvec3 n(0, std::sqrt(0.5), std::sqrt(0.5));
    CHECK(glm::distance(m.vertex.normal, n) < 1e-15);
    CHECK(glm::distance(m.vertex.displaced_position, glm::dvec3(2, 2, 3) + 48.0 * n) < 1e-13);

    CHECK(m.bump_length == Approx(1));
    CHECK(complete_base_vertex(b, map, p).generation == 0);

    b.normal = -a.normal;  // the mean has no direction
    CHECK(insert_vertex(a, b, map, p).vertex.displaced_normal == glm::dvec3(0));
    b.position.z = -1;  // w = 1, on the near plane
    b.texture = {0, 0};
    p.bias = 0;
    CHECK_FALSE(complete_base_vertex(b, map, p).in_front);
}
