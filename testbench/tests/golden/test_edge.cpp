// The decision whether to split an edge.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "golden/golden_model.h"
#include "golden/height_tests/rank_test.h"
#include "testbench/tests/golden/golden_cases.h"

using namespace tessera::golden;
using namespace tessera::golden::testing;

namespace {

bool same_bits(double a, double b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}
template <class Vector>
bool same_bits(const Vector& a, const Vector& b) {
    for (int k = 0; k < Vector::length(); ++k)
        if (!same_bits(a[k], b[k]))
            return false;
    return true;
}

bool same_bits(const Vertex& a, const Vertex& b) {
    return same_bits(a.position, b.position) && same_bits(a.normal, b.normal) && same_bits(a.tangent, b.tangent) &&
           same_bits(a.handedness, b.handedness) && same_bits(a.texture, b.texture) &&
           same_bits(a.displaced_position, b.displaced_position) && same_bits(a.displaced_normal, b.displaced_normal) &&
           same_bits(a.screen, b.screen) && same_bits(a.w, b.w) && a.in_front == b.in_front &&
           a.generation == b.generation;
}

bool same_bits(const EdgeEvaluation& a, const EdgeEvaluation& b) {
    return same_bits(a.inserted.vertex, b.inserted.vertex) &&
           same_bits(a.inserted.mean_normal_length, b.inserted.mean_normal_length) &&
           same_bits(a.inserted.mean_tangent_length, b.inserted.mean_tangent_length) &&
           same_bits(a.inserted.bump_length, b.inserted.bump_length) &&
           same_bits(a.normal_difference, b.normal_difference) && a.rectangle_width == b.rectangle_width &&
           a.rectangle_height == b.rectangle_height && same_bits(a.height, b.height) &&
           same_bits(a.height_limit, b.height_limit) && same_bits(a.view_length, b.view_length) &&
           a.normal_test == b.normal_test && a.summed_height_test == b.summed_height_test &&
           a.view_test == b.view_test && a.tex_coord_test == b.tex_coord_test &&
           a.generation_test == b.generation_test && a.split == b.split;
}

Vertex random_vertex(Random& random, double low_u, double high_u, double low_v, double high_v) {
    Vertex v;
    v.position = {random.real(-10, 10), random.real(-10, 10), random.real(-10, 10)};
    v.normal = random.unit();
    v.tangent = random.unit();
    v.handedness = random.integer(0, 1) == 0 ? -1 : 1;
    v.texture = {random.grid(low_u, high_u), random.grid(low_v, high_v)};
    return v;
}

}  // namespace

TEST_CASE("edge: each test decides operands worked out by hand") {
    std::vector<double> codes = constant_codes(16, 16, 0);
    codes[4 * 16 + 8] = 100;
    Map map(16, 16, AddressMode::clamp, AddressMode::clamp, codes);
    Parameters p;
    const auto vertex = [&](double u, double v) {
        Vertex a;
        a.position = {u, v, 0};
        a.normal = {0, 0, 1};
        a.tangent = {1, 0, 0};
        a.texture = {u, v};
        return complete_base_vertex(a, map, p);
    };

    SECTION("summed height, strictly greater, and the area option") {
        p.enabled.normal = false;
        const Vertex i = vertex(4.5, 4.5), j = vertex(12.5, 4.5);  // rectangles of 4 x 1; only r_ij contains the peak
        set_summed_height(map, 49);                                // |100/2 - 0| > 49
        EdgeEvaluation e = evaluate_edge(i, j, map, p);
        CHECK(e.rectangle_width == 4);
        CHECK(e.rectangle_height == 1);
        CHECK(e.height == 200);
        CHECK(e.summed_height_test);
        CHECK(e.split);
        set_summed_height(map, 50);
        CHECK_FALSE(evaluate_edge(i, j, map, p).summed_height_test);
        set_summed_height(map, 50, true);
        CHECK_FALSE(evaluate_edge(i, j, map, p).summed_height_test);  // 200 > 50 * 4
        set_summed_height(map, 49, true);
        e = evaluate_edge(i, j, map, p);
        CHECK(e.height_limit == 196);
        CHECK(e.summed_height_test);
        p.enabled.summed_height = false;
        CHECK_FALSE(evaluate_edge(i, j, map, p).split);
        // The peak under an end counts once instead of twice, with the opposite sign.
        CHECK(evaluate_edge(vertex(8.5, 4.5), vertex(14.5, 4.5), map, p).height == 100);
    }
    SECTION("normal: the largest of six differences, against either end") {
        p.enabled.summed_height = false;
        std::vector<glm::dvec3> normals(256, glm::dvec3(0, 0, 1));
        normals[8] = {0.6, 0, 0.8};
        map.set_normals(normals);
        p.normal_threshold = 0.59;
        CHECK(evaluate_edge(vertex(8.5, 0.5), vertex(2.5, 0.5), map, p).normal_test);   // only at an end
        CHECK(evaluate_edge(vertex(2.5, 0.5), vertex(8.5, 0.5), map, p).normal_test);   // only at the other
        CHECK(evaluate_edge(vertex(4.5, 0.5), vertex(12.5, 0.5), map, p).normal_test);  // only in the middle
        CHECK_FALSE(evaluate_edge(vertex(9.5, 0.5), vertex(15.5, 0.5), map, p).normal_test);
        p.normal_threshold = 0.61;
        const EdgeEvaluation e = evaluate_edge(vertex(4.5, 0.5), vertex(12.5, 0.5), map, p);
        CHECK(e.normal_difference == Approx(0.6));
        CHECK_FALSE(e.normal_test);
        p.normal_threshold = 0;
        p.enabled.normal = false;
        CHECK_FALSE(evaluate_edge(vertex(4.5, 0.5), vertex(12.5, 0.5), map, p).normal_test);
    }
    SECTION("view: Manhattan, and the near plane") {
        p.row_w = {0, 0, 1, 1};
        Vertex i = vertex(2, 3), j = vertex(5, 7);
        p.view_threshold = 6.9;
        CHECK(evaluate_edge(i, j, map, p).view_length == 7);
        CHECK(evaluate_edge(i, j, map, p).view_test);
        p.view_threshold = 7;
        CHECK_FALSE(evaluate_edge(i, j, map, p).view_test);
        j.in_front = false;
        p.view_threshold = 1e300;
        CHECK(evaluate_edge(i, j, map, p).view_test);
        i.in_front = false;
        p.view_threshold = -1;
        CHECK_FALSE(evaluate_edge(i, j, map, p).view_test);
        p.enabled.view = false;
        CHECK(evaluate_edge(i, j, map, p).view_test);
    }
    SECTION("texture coordinate: same texel as either end, in both components") {
        CHECK_FALSE(evaluate_edge(vertex(2.1, 2), vertex(3.5, 2), map, p).tex_coord_test);
        CHECK_FALSE(evaluate_edge(vertex(2.9, 2), vertex(3.5, 2), map, p).tex_coord_test);
        CHECK(evaluate_edge(vertex(2.9, 2), vertex(4.1, 2), map, p).tex_coord_test);
        CHECK(evaluate_edge(vertex(2.0, 2.9), vertex(2.0, 4.1), map, p).tex_coord_test);
        p.enabled.tex_coord = false;
        CHECK(evaluate_edge(vertex(2.1, 2), vertex(3.5, 2), map, p).tex_coord_test);
    }
    SECTION("generation: that of the inserted vertex is at most the limit") {
        Vertex i = vertex(2, 2), j = vertex(9, 2);
        j.generation = 11;
        CHECK(evaluate_edge(i, j, map, p).generation_test);
        j.generation = 12;
        CHECK_FALSE(evaluate_edge(i, j, map, p).generation_test);
        p.enabled.generation = false;
        CHECK(evaluate_edge(i, j, map, p).generation_test);
    }
    SECTION("every test is needed for a split") {
        const Vertex i = vertex(4.5, 4.5), j = vertex(12.5, 4.5);
        CHECK(evaluate_edge(i, j, map, p).split);
        Parameters no = p;
        no.view_threshold = 1e9;
        CHECK_FALSE(evaluate_edge(i, j, map, no).split);
        no = p;
        no.generation_limit = 0;
        CHECK_FALSE(evaluate_edge(i, j, map, no).split);
        no = p;
        no.normal_threshold = -1;  // always true, so that only TCT can prevent the split
        CHECK_FALSE(evaluate_edge(vertex(4.1, 4.1), vertex(4.2, 4.9), map, no).split);
        no.normal_threshold = 1e9;
        set_summed_height(map, 1e9);
        CHECK_FALSE(evaluate_edge(i, j, map, no).split);
    }
}

TEST_CASE("edge: summed height equals its definition, texel by texel") {
    Random random;
    for (const auto& [width, height] : sizes) {
        for (const AddressMode mode : both_modes) {
            const Map map(width, height, mode, mode, random_codes(width, height, random));
            const double reach = mode == AddressMode::repeat ? 3 : 1;
            for (int k = 0; k < 300; ++k) {
                const double w = width, h = height;
                const Vertex i = random_vertex(random, (1 - reach) * w, reach * w, (1 - reach) * h, reach * h);
                const Vertex j = random_vertex(random, (1 - reach) * w, reach * w, (1 - reach) * h, reach * h);
                const EdgeEvaluation e = evaluate_edge(i, j, map, {});
                const auto sum_about = [&](const glm::dvec2& t) {
                    return static_cast<double>(
                        map.brute_force_sum(map.rectangle_about(t, {0, 0, e.rectangle_width, e.rectangle_height})));
                };
                REQUIRE(e.rectangle_width <= width);
                REQUIRE(e.rectangle_height <= height);
                REQUIRE(e.height == std::abs(2 * sum_about((i.texture + j.texture) / 2.0) - sum_about(i.texture) -
                                             sum_about(j.texture)));
            }
        }
    }
}

TEST_CASE("a constant map splits no edge at any position") {
    Random random;
    for (const auto& [width, height] : sizes) {
        for (const AddressMode mode : both_modes) {
            for (const double code : {0.0, 1.0, 255.0, 65535.0}) {
                Map map(width, height, mode, mode, constant_codes(width, height, code));
                Parameters p;
                p.scale = 0.37;
                map.derive_normals(p.scale, {0.1, 0.2});
                for (int k = 0; k < 200; ++k) {
                    Vertex i = random_vertex(random, -2.0 * width, 3.0 * width, -2.0 * height, 3.0 * height);
                    Vertex j = random_vertex(random, -2.0 * width, 3.0 * width, -2.0 * height, 3.0 * height);
                    i.normal = j.normal = {0, 0, 1};
                    i.tangent = j.tangent = {1, 0, 0};
                    i = complete_base_vertex(i, map, p);
                    j = complete_base_vertex(j, map, p);
                    const EdgeEvaluation e = evaluate_edge(i, j, map, p);  // all thresholds 0
                    REQUIRE(e.height == 0);
                    REQUIRE(e.normal_difference == 0);
                    REQUIRE_FALSE(e.split);
                }
            }
        }
    }
}

TEST_CASE("a map constant over the edge's three rectangles has no summed height") {
    Random random;
    for (const AddressMode mode : both_modes) {
        for (int k = 0; k < 200; ++k) {
            const Vertex i = random_vertex(random, 0, 64, 0, 64), j = random_vertex(random, 0, 64, 0, 64);
            std::vector<double> codes = random_codes(64, 64, random);
            const Map plain(64, 64, mode, mode, codes);
            const Rectangle size = plain.rectangle_size(i.texture, j.texture);
            for (const glm::dvec2& t : {i.texture, j.texture, (i.texture + j.texture) / 2.0}) {
                const Rectangle r = plain.rectangle_about(t, size);
                for (std::int64_t y = r.y; y < r.y + r.height; ++y)
                    for (std::int64_t x = r.x; x < r.x + r.width; ++x)
                        codes[static_cast<std::size_t>(y % 64 * 64 + x % 64)] = 4711;
            }
            REQUIRE(evaluate_edge(i, j, Map(64, 64, mode, mode, codes), {}).height == 0);
        }
    }
}

TEST_CASE("edge: (i,j) and (j,i) are decided alike, bit for bit") {
    Random random;
    for (const auto& [width, height] : sizes) {
        for (const AddressMode mode : both_modes) {
            Map map(width, height, mode, mode, random_codes(width, height, random));
            map.derive_normals(1e-4, {0.1, 0.2});
            for (int k = 0; k < 2000; ++k) {
                Parameters p;
                p.scale = random.real(0, 1e-3);
                p.bias = random.real(-1, 1);
                p.row_x = {random.real(-9, 9), random.real(-9, 9), random.real(-9, 9), 1};
                p.row_w = {0, 0, random.real(0, 1), random.real(0, 9)};
                p.normal_threshold = random.real(0, 2);
                const double threshold = random.real(0, 1e5);
                p.view_threshold = random.real(0, 30);
                set_summed_height(map, threshold, random.integer(0, 1) == 0);
                Vertex i = complete_base_vertex(random_vertex(random, -9, width, 0, height), map, p);
                Vertex j = complete_base_vertex(random_vertex(random, 0, width, 0, height), map, p);
                i.generation = static_cast<int>(random.integer(0, 13));
                j.generation = static_cast<int>(random.integer(0, 13));
                REQUIRE(same_bits(evaluate_edge(i, j, map, p), evaluate_edge(j, i, map, p)));
            }
        }
    }
}

TEST_CASE("repeat: an edge any number of periods away decides the same") {
    Random random;
    Map map(12, 19, AddressMode::repeat, AddressMode::repeat, random_codes(12, 19, random));
    map.derive_normals(1e-4, {0.1, 0.2});
    Parameters p;
    p.scale = 1e-4;
    for (int k = 0; k < 5000; ++k) {
        Vertex i = random_vertex(random, 0, 12, 0, 19), j = random_vertex(random, 0, 12, 0, 19);
        const EdgeEvaluation here =
            evaluate_edge(complete_base_vertex(i, map, p), complete_base_vertex(j, map, p), map, p);
        const glm::dvec2 periods(12.0 * static_cast<double>(random.integer(-50, 50)),
                                 19.0 * static_cast<double>(random.integer(-50, 50)));
        i.texture += periods;
        j.texture += periods;
        EdgeEvaluation there = evaluate_edge(complete_base_vertex(i, map, p), complete_base_vertex(j, map, p), map, p);
        there.inserted.vertex.texture -= periods;
        REQUIRE(same_bits(here, there));
    }
}

TEST_CASE("edge: thresholds as the viewer sees them equal those worked out by hand") {
    CHECK(eye_distance({3, -4, 0}) == Approx(7 * 11.0 / 16));
    CHECK(eye_distance({-5, 1, 1}) == 5);
    CHECK(eye_distance({2, 2, -2}) == Approx(6 * 9.0 / 16));
    CHECK(level(1) == 0);
    CHECK(level(3) == 4096 + 2048);
    CHECK(level(0.25) == -2 * 4096);

    Map map(8, 8, AddressMode::clamp, AddressMode::clamp, std::vector<double>(64, 0));
    Parameters parameters;
    RankSettings settings{1000, 60000, 16, 16, RankView::per_point};
    parameters.distance_step = 0.25;
    parameters.eye = {0, 0, -8};
    parameters.enabled = {false, true, false, false, false, false};
    Vertex i, j;
    i.normal = j.normal = {0, 0, 1};
    i.tangent = j.tangent = {1, 0, 0};
    i.texture = {0.5, 0.5};
    j.texture = {2.5, 0.5};
    const auto asks = [&](std::uint16_t rank, std::uint16_t bound, std::uint8_t radius) {
        const RankTable table{8,
                              8,
                              std::vector<std::uint16_t>(64, rank),
                              std::vector<std::uint16_t>(64, bound),
                              std::vector<std::uint8_t>(64, radius),
                              0,
                              {}};
        map.set_height_test(std::make_shared<RankTest>(table, settings));
        return evaluate_edge(complete_base_vertex(i, map, parameters), complete_base_vertex(j, map, parameters), map,
                             parameters)
            .summed_height_test;
    };
    // Both ends are at distance 8: three octaves, of 2 x 1024 for a rank, 2048 for a bound.
    CHECK_FALSE(asks(1000 + 3 * 2048, 0, 0));
    CHECK(asks(1001 + 3 * 2048, 0, 0));
    settings.view = RankView::per_pixel;
    CHECK_FALSE(asks(1000 + 3 * 4096, 0, 0));
    CHECK(asks(1001 + 3 * 4096, 0, 0));
    // A radius of 8 x 4 half steps: 4 of the distance 8.
    settings.bound_threshold = 500;
    CHECK_FALSE(asks(0, 500 + 2 * 2048, 16));
    CHECK(asks(0, 501 + 2 * 2048, 16));
    CHECK(asks(0, 1, 24));  // radius 8: the eye lies in the sphere
    CHECK_FALSE(asks(0, 0, 24));
    parameters.row_w = {0, 0, 0, -8};  // the camera looks away
    CHECK(asks(0, 1, 24));
    parameters.row_w = {0, 0, 0, -8.5};
    CHECK_FALSE(asks(0, 1, 24));
}
