#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/pack_triangle.h"
#include "testbench/prove/random_edges/datapath_edge.h"
#include "testbench/prove/random_edges/datapath_random.h"
#include "testbench/prove/random_edges/datapath_random_tables.h"

/// The Highlight Test: one of three normals in the highlight, and a difference above its threshold.
using namespace tessera::datapath;
using namespace tessera::testing;

namespace {

double real(std::int32_t value) {
    return value;
}

/// The definition again, in doubles, which hold every number here exactly.
bool reference(const Direction& i, const Direction& j, const Direction& ij, const TestParameters& parameters) {
    const auto cosine = [&](const Direction& n) {
        return real(n.x) * parameters.half_vector[0] + real(n.y) * parameters.half_vector[1] +
               real(n.z) * parameters.half_vector[2];
    };
    const double nearest = std::max({cosine(i), cosine(j), cosine(ij)});
    double largest = 0;
    for (const Direction& end : {i, j})
        for (const double difference : {real(ij.x) - end.x, real(ij.y) - end.y, real(ij.z) - end.z})
            largest = std::max(largest, std::fabs(difference));
    return nearest > static_cast<double>(parameters.highlight_cosine) &&
           largest > parameters.highlight_normal_threshold;
}

TestParameters parameters_of(std::array<std::int32_t, 3> half, std::int64_t cosine, std::uint32_t threshold) {
    TestParameters parameters;
    parameters.highlight_test = true;
    parameters.half_vector = half;
    parameters.highlight_cosine = cosine;
    parameters.highlight_normal_threshold = threshold;
    return parameters;
}

std::vector<Direction> all_directions(std::int32_t least, std::int32_t most) {
    std::vector<Direction> all;
    for (std::int32_t x = least; x <= most; ++x)
        for (std::int32_t y = least; y <= most; ++y)
            for (std::int32_t z = least; z <= most; ++z)
                all.push_back({x, y, z});
    return all;
}

}  // namespace

TEST_CASE("Highlight Test: every edge of 2-bit normals follows the definition, in both directions") {
    const std::vector<Direction> all = all_directions(-2, 1);
    std::uint64_t asked = 0;
    for (const auto& parameters :
         {parameters_of({1, 1, 1}, 2, 0), parameters_of({-2, 0, 1}, 1, 1), parameters_of({0, 0, 1}, 0, 2),
          parameters_of({1, -2, 0}, 3, 0), parameters_of({0, 0, 0}, 0, 0)}) {
        for (const Direction& i : all)
            for (const Direction& j : all)
                for (const Direction& ij : all) {
                    const bool asks = highlight_test(i, j, ij, parameters);
                    asked += asks ? 1 : 0;
                    if (asks != highlight_test(j, i, ij, parameters) || asks != reference(i, j, ij, parameters))
                        FAIL(i.x << " " << i.y << " " << i.z << ", " << j.x << " " << j.y << " " << j.z << ", " << ij.x
                                 << " " << ij.y << " " << ij.z);
                }
    }
    CHECK(asked > 100'000);
}

TEST_CASE("Highlight Test: random normals of the widest formats follow the definition, in both directions") {
    Random random(51);
    std::array<int, 2> seen{};
    for (const std::int32_t limit : {31, 1 << 11, 1 << 15, 1 << 17}) {
        for (int k = 0; k < 200'000; ++k) {
            const auto direction = [&] {
                return Direction{random.integer32(-limit, limit - 1), random.integer32(-limit, limit - 1),
                                 random.integer32(-limit, limit - 1)};
            };
            const Direction i = direction(), j = direction(), ij = random.coin() ? direction() : i;
            const Direction h = direction();
            auto parameters =
                parameters_of({h.x, h.y, h.z}, 0, random.natural(0, 2 * static_cast<std::uint32_t>(limit)));
            parameters.highlight_cosine = random.any_size(std::int64_t{limit} * limit);
            const bool asks = highlight_test(i, j, ij, parameters);
            ++seen[asks ? 1 : 0];
            if (asks != highlight_test(j, i, ij, parameters) || asks != reference(i, j, ij, parameters))
                FAIL("limit " << limit << ", edge " << k);
        }
    }
    CHECK(seen[0] > 10'000);
    CHECK(seen[1] > 10'000);
}

TEST_CASE("Highlight Test: a cosine equal to the limit is outside, one LSB more is inside") {
    const Direction on{0, 0, 1000}, off{0, 0, -1000};
    const auto asks = [&](const Direction& i, const Direction& j, const Direction& ij, std::int64_t cosine,
                          std::uint32_t threshold) {
        return highlight_test(i, j, ij, parameters_of({0, 0, 16384}, cosine, threshold));
    };
    const std::int64_t border = std::int64_t{1000} * 16384;
    for (const auto& [i, j, ij] : {std::array{on, off, off}, std::array{off, on, off},
                                   std::array{off, off, on}}) {  // each of the three suffices
        CHECK(asks(i, j, ij, border - 1, 1999));
        CHECK_FALSE(asks(i, j, ij, border, 1999));
        CHECK_FALSE(asks(i, j, ij, border - 1, 2000));
    }
    // the largest possible sum, of the widest normals
    const std::int32_t lowest = -(1 << 17);
    const Direction largest{lowest, lowest, lowest};
    const auto widest = parameters_of({lowest, lowest, lowest}, 3 * (std::int64_t{1} << 34) - 1, 0);
    CHECK(in_highlight(largest, widest));
    CHECK_FALSE(in_highlight({lowest, lowest, lowest + 1}, widest));
}

TEST_CASE("Highlight Test: never splits between equal normals, or with a zero half vector") {
    Random random(52);
    for (int k = 0; k < 100'000; ++k) {
        const Direction n{random.integer32(-16384, 16384), random.integer32(-16384, 16384),
                          random.integer32(-16384, 16384)};
        CHECK_FALSE(highlight_test(n, n, n, parameters_of({n.x, n.y, n.z}, 0, 0)));
        const Direction m{-n.z, n.x, n.y};
        CHECK_FALSE(highlight_test(n, m, m, parameters_of({0, 0, 0}, 0, 0)));
    }
}

TEST_CASE("split decision: (NT or SHT or HT) and VT and TCT and GT, all 64 rows") {
    for (unsigned row = 0; row < 64; ++row) {
        const bool asked = (row & (normal_bit | summed_height_bit | highlight_bit)) != 0;
        const bool allowed = (row & view_bit) != 0 && (row & tex_coord_bit) != 0 && (row & generation_bit) != 0;
        CHECK(split_decision(static_cast<std::uint8_t>(row)) == (asked && allowed));
    }
}

TEST_CASE("symmetry: with a Highlight Test, decision and inserted vertex are the same from both sides") {
    Random random(53);
    Registers registers;
    registers.map = {64, 48, AddressMode::clamp, AddressMode::repeat};
    Tables tables = random_tables(random, registers);
    registers.tests = parameters_of({0, 0, 1 << 14}, 200'000'000, 9000);
    registers.tests.normal_threshold = 30000;
    registers.tests.height_thresholds[0] = ~0U;
    registers.displacement = {1 << 15, -9000};
    Machine machine(registers, std::move(tables));
    int alone = 0, edges = 0;
    for (int k = 0; k < 200'000; ++k) {
        const auto vertex = [&] {
            Vertex v;
            v.texture = {random.natural(0, 64 << 12), random.natural(0, 96 << 12)};
            v.normal = random_normal(random, registers.formats);
            v.tangent = random_normal(random, registers.formats);
            v.position = {random.integer32(-99999, 99999), random.integer32(-99999, 99999), 0};
            machine.complete(v);
            return v;
        };
        TrianglePass pass;
        const Vertex i = vertex(), j = vertex();
        pass.triangle.vertices = {i, j, i};
        machine.evaluate_edge(pass, 0);
        machine.evaluate_edge(pass, 1);
        ++edges;
        alone += (pass.edges[0].tests & requesting_tests) == highlight_bit;
        if (pass.edges[0].tests != pass.edges[1].tests ||
            !same_bits(inserted_vertex(pass, 0), inserted_vertex(pass, 1)))
            FAIL("edge " << k);
    }
    CHECK(alone > edges / 20);
    CHECK(alone < edges);
}

TEST_CASE("queue entry: one bit wider with a Highlight Test") {
    Formats without, with;
    with.highlight_tag = true;
    CHECK(stream_widths(with).triangle == stream_widths(without).triangle + 1);
    CHECK(stream_widths(with).vertex == stream_widths(without).vertex);
    Random random(54);
    for (int k = 0; k < 1000; ++k) {
        Triangle triangle;
        for (Vertex& v : triangle.vertices)
            v.position = {random.integer32(-99999, 99999), random.integer32(-99999, 99999), k};
        triangle.base = random.natural(0, 0xffffffff);
        triangle.split_by = static_cast<std::uint8_t>(random.natural(0, 3) | (random.coin() ? highlight_bit : 0));
        triangle.stopped_by = static_cast<std::uint8_t>(random.natural(0, 7) << 2);
        triangle.finished = random.coin();
        std::array<unsigned char, 512> bytes{};
        REQUIRE(packed_triangle_bytes(with) + packed_triangle_tag_bytes <= bytes.size());
        CHECK(pack_triangle(triangle, with, bytes.data()));
        const Triangle back = unpack_triangle(bytes.data(), with);
        CHECK(back.split_by == triangle.split_by);
        CHECK(back.stopped_by == triangle.stopped_by);
        CHECK(back.finished == triangle.finished);
        CHECK(back.base == triangle.base);
        CHECK(back.vertices[2].position == triangle.vertices[2].position);
        // without this bit a triangle of the Highlight Test does not fit, and the writer reports it
        CHECK(pack_triangle(triangle, without, bytes.data()) == ((triangle.split_by & highlight_bit) == 0));
    }
}

TEST_CASE("children record that the Highlight Test split their parent") {
    TrianglePass pass;
    pass.split = 1;
    pass.edges[0].tests = highlight_bit | gating_tests;
    pass.edges[1].tests = normal_bit | view_bit;  // not split: not counted
    int children = 0;
    Saturations saturations;
    tessellate(pass, Triangulation::shorter, Formats{}, saturations, [&](const Triangle& child) {
        ++children;
        CHECK(child.split_by == highlight_bit);
    });
    CHECK(children == 2);
}
