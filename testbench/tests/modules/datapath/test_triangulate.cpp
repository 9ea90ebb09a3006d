#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

#include "modules/datapath/midpoint.h"
#include "modules/datapath/triangulate.h"
#include "testbench/common/random.h"

using namespace tessera::datapath;
using tessera::Random;

namespace {

using Point = std::pair<std::int64_t, std::int64_t>;

/// The six points on a parent whose midpoints are exact.
std::array<Point, 6> points_of(const Point& a, const Point& b, const Point& c) {
    const auto middle = [](const Point& p, const Point& q) {
        return Point{(p.first + q.first) / 2, (p.second + q.second) / 2};
    };
    return {a, b, c, middle(a, b), middle(b, c), middle(c, a)};
}

std::int64_t doubled_area(const Point& a, const Point& b, const Point& c) {
    return (b.first - a.first) * (c.second - a.second) - (b.second - a.second) * (c.first - a.first);
}

/// The parent's border, walked once, as directed edges between indices.
std::map<std::pair<int, int>, int> border(unsigned split) {
    std::map<std::pair<int, int>, int> edges;
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        if ((split >> k & 1) != 0) {
            edges[{k, 3 + k}] = 1;
            edges[{3 + k, next}] = 1;
        } else {
            edges[{k, next}] = 1;
        }
    }
    return edges;
}

constexpr std::array<int, 8> children_of{1, 2, 2, 3, 2, 3, 3, 4};

}  // namespace

TEST_CASE("triangulate: all eight splits, both diagonals: covers the parent, keeps winding, no edge missing or extra") {
    for (unsigned split = 0; split < 8; ++split) {
        for (const bool second : {false, true}) {
            const ChildIndices result = triangulate(split, second);
            CHECK(result.count == children_of[split]);
            std::map<std::pair<int, int>, int> edges;
            for (int k = 0; k < result.count; ++k) {
                const auto& child = result.children[static_cast<std::size_t>(k)];
                for (std::size_t e = 0; e < 3; ++e)
                    ++edges[{child[e], child[(e + 1) % 3]}];
            }
            // Without the inner edges, which occur once in each direction, the border remains, each piece once.
            std::map<std::pair<int, int>, int> outer;
            for (const auto& [edge, uses] : edges) {
                CHECK(uses == 1);
                if (edges.count({edge.second, edge.first}) == 0)
                    outer[edge] = uses;
            }
            CHECK(outer == border(split));

            Random random(24);
            for (int k = 0; k < 2'000; ++k) {
                const auto even = [&] {
                    return Point{2 * random.integer(-5000, 5000), 2 * random.integer(-5000, 5000)};
                };
                const Point a = even(), b = even(), c = even();
                const std::int64_t whole = doubled_area(a, b, c);
                if (whole == 0)
                    continue;
                const std::array<Point, 6> p = points_of(a, b, c);
                std::int64_t sum = 0;
                for (int child = 0; child < result.count; ++child) {
                    const auto& v = result.children[static_cast<std::size_t>(child)];
                    const std::int64_t area = doubled_area(p[v[0]], p[v[1]], p[v[2]]);
                    if (area == 0 || (area > 0) != (whole > 0))
                        FAIL("split " << split << ", child " << child << " turned over or collapsed");
                    sum += area;
                }
                if (sum != whole)
                    FAIL("split " << split << " does not cover");
            }
        }
    }
}

TEST_CASE("triangulate: with two split edges, the two choices differ only in the diagonal") {
    for (const unsigned split : {3u, 5u, 6u}) {
        const ChildIndices first = triangulate(split, false), second = triangulate(split, true);
        CHECK(first.children[0] == second.children[0]);  // the cut-off corner
        CHECK(first.children[1] != second.children[1]);
    }
    for (const unsigned split : {0u, 1u, 2u, 4u, 7u})
        CHECK(triangulate(split, false).children == triangulate(split, true).children);
}

TEST_CASE("triangulate: the corner cut off is opposite the unsplit edge") {
    const auto corner = [](unsigned split) { return triangulate(split, false).children[0]; };
    CHECK(corner(3) == std::array<std::uint8_t, 3>{3, 1, 4});
    CHECK(corner(6) == std::array<std::uint8_t, 3>{5, 4, 2});
    CHECK(corner(5) == std::array<std::uint8_t, 3>{0, 3, 5});
}

TEST_CASE("remaining quadrilateral: vertices are in the triangle's order from the first that remains") {
    using Four = std::array<std::uint8_t, 4>;
    // the walk 0 3 1 4 2 5 without the corner opposite the unsplit edge
    CHECK(remaining_quadrilateral(0) == Four{0, 1, 4, 5});
    CHECK(remaining_quadrilateral(1) == Four{3, 1, 2, 5});
    CHECK(remaining_quadrilateral(2) == Four{0, 3, 4, 2});
}

TEST_CASE("diagonal: the second is chosen if it is shorter than the first by more than a 64th") {
    Random random(25);
    int close = 0, seconds = 0;
    for (int k = 0; k < 600'000; ++k) {
        const std::int64_t limit = k % 2 == 0 ? 40 : 0x7fffffff;  // small coordinates give close lengths
        std::array<Position, 6> p;
        for (Position& at : p)
            at = {random.integer32(-limit - 1, limit), random.integer32(-limit - 1, limit),
                  random.integer32(-limit - 1, limit)};
        const auto corner = [&](std::uint8_t index) { return p[index]; };
        const auto length = [&](int a, int b) {
            const Position &from = p[static_cast<std::size_t>(a)], &to = p[static_cast<std::size_t>(b)];
            return std::abs(double{1} * from.x - to.x) + std::abs(double{1} * from.y - to.y) +
                   std::abs(double{1} * from.z - to.z);
        };
        const auto check = [&](unsigned split, double first, double second) {
            const bool expected = second < first - first / 64;  // exact in a double
            close += second < first && !expected ? 1 : 0;
            seconds += expected ? 1 : 0;
            if (choose_second_diagonal(split, Triangulation::shorter, corner) != expected ||
                choose_second_diagonal(split, Triangulation::first, corner) ||
                !choose_second_diagonal(split, Triangulation::second, corner))
                FAIL("split " << split << ": " << first << " and " << second);
        };
        check(6, length(0, 4), length(1, 5));
        check(5, length(3, 2), length(1, 5));
        check(3, length(0, 4), length(3, 2));
    }
    CHECK(close > 5'000);
    CHECK(seconds > 500'000);
}

TEST_CASE("diagonal: rounding errors do not decide between equal lengths") {
    // A square of 640 LSB over a level map, its corners moved by a few LSB: first diagonal 0 to 4, second 1 to 5.
    const auto second = [](int first_length, int second_length) {
        std::array<Position, 6> p{};
        p[4] = {first_length, 0, 0};
        p[1] = {0, 9, 0};
        p[5] = {second_length, 9, 0};
        return choose_second_diagonal(6, Triangulation::shorter, [&](std::uint8_t index) { return p[index]; });
    };
    CHECK_FALSE(second(640, 640));
    CHECK_FALSE(second(640, 639));
    CHECK_FALSE(second(640, 630));  // 63 / 64 of it
    CHECK(second(640, 629));
    CHECK_FALSE(second(0, 0));
}

TEST_CASE("diagonal: without two split edges none is chosen") {
    const auto corner = [](std::uint8_t) -> Position {
        FAIL("no position is needed");
        return {};
    };
    for (const unsigned split : {0u, 1u, 2u, 4u, 7u})
        CHECK_FALSE(choose_second_diagonal(split, Triangulation::shorter, corner));
}

TEST_CASE("Manhattan length: 34 bits") {
    constexpr std::int32_t low = std::numeric_limits<std::int32_t>::min(), high = 0x7fffffff;
    CHECK(manhattan_length({low, low, low}, {high, high, high}) == 3 * std::uint64_t{0xffffffff});
    CHECK(manhattan_length({1, 2, 3}, {-1, 5, 3}) == 5);
    CHECK(manhattan_length({-1, 5, 3}, {1, 2, 4}) == 6);
}
