#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "testbench/common/random.h"
#include "testbench/prove/random_edges/datapath_edge.h"

using namespace tessera::datapath;
using namespace tessera::testing;
using tessera::Random;

namespace {

Position any_position(Random& random) {
    return {random.integer32(-1000, 1000), random.integer32(-1000, 1000), random.integer32(-1000, 1000)};
}
Direction any_direction(Random& random) {
    return {random.integer32(-1000, 1000), random.integer32(-1000, 1000), random.integer32(-1000, 1000)};
}
ScreenPosition any_screen(Random& random) {
    return {random.integer32(-1000, 1000), random.integer32(-1000, 1000), random.integer32(-1000, 1000), random.coin()};
}
TexCoord any_texture(Random& random) {
    return {random.natural(0, 1000), random.natural(0, 1000)};
}

/// A vertex in which every field differs from every other vertex's.
Vertex any_vertex(Random& random) {
    Vertex v;
    v.position = any_position(random);
    v.normal = any_direction(random);
    v.tangent = any_direction(random);
    v.texture = any_texture(random);
    v.handedness = random.coin() ? std::int8_t{1} : std::int8_t{-1};
    v.generation = static_cast<std::uint8_t>(random.integer(0, 11));
    v.displaced_known = true;
    v.screen_normal_known = random.coin();
    v.code = static_cast<std::uint16_t>(random.integer(0, 65535));
    v.displaced = any_position(random);
    v.displaced_normal = any_direction(random);
    v.screen = any_screen(random);
    v.screen_normal = any_direction(random);
    return v;
}

TrianglePass any_pass(Random& random) {
    TrianglePass pass;
    for (std::size_t k = 0; k < 3; ++k) {
        pass.triangle.vertices[k] = any_vertex(random);
        pass.new_vertex[k] = {any_position(random), any_direction(random),
                              any_texture(random),  static_cast<std::uint16_t>(random.integer(0, 65535)),
                              any_position(random), any_screen(random)};
        pass.edges[k] = {any_texture(random), any_direction(random), any_direction(random), any_direction(random),
                         static_cast<std::uint8_t>(random.integer(0, all_tests))};
    }
    pass.number = random.natural(0, 1000);
    pass.triangle.parent = random.natural(0, 1000);
    pass.triangle.base = random.natural(0, 1000);
    pass.triangle.split_by = static_cast<std::uint8_t>(random.integer(1, 3));
    pass.triangle.stopped_by = static_cast<std::uint8_t>(random.integer(0, 7) << 2);
    pass.split = static_cast<std::uint8_t>(random.integer(0, 7));
    pass.triangle.finished = pass.split == 0;
    return pass;
}

/// Requires equality with itself, and inequality with every copy in which one field differs.
template <class Part, class... Fields>
void check_equality(const Part& part, Fields Part::*... fields) {
    CHECK(part == part);
    const auto differs = [&](auto field) {
        Part other = part;
        other.*field = !(other.*field);
        return !(other == part) && !(part == other);
    };
    CHECK((differs(fields) && ...));
}

}  // namespace

TEST_CASE("vertex: parts are equal only if every field is") {
    check_equality(Position{5, 6, 7}, &Position::x, &Position::y, &Position::z);
    check_equality(Direction{5, 6, 7}, &Direction::x, &Direction::y, &Direction::z);
    check_equality(TexCoord{5, 6}, &TexCoord::u, &TexCoord::v);
    check_equality(ScreenPosition{5, 6, 7, true, 8}, &ScreenPosition::x, &ScreenPosition::y, &ScreenPosition::w,
                   &ScreenPosition::in_front, &ScreenPosition::distance);
}

TEST_CASE("tessellate: children carry complete vertices and the parent's tags") {
    Random random(26);
    Formats formats;
    Saturations saturations;
    std::uint64_t saturated = 0;
    for (int k = 0; k < 20'000; ++k) {
        const TrianglePass pass = any_pass(random);
        formats.generation_bits = static_cast<int>(random.integer(1, 4));
        formats.final_edges = random.coin();
        const int highest_generation = (1 << formats.generation_bits) - 1;
        const auto choice = static_cast<Triangulation>(random.integer(0, 2));

        std::array<Vertex, 6> expected;
        int split_by = 0;
        for (std::size_t e = 0; e < 3; ++e) {
            const Vertex &i = pass.triangle.vertices[e], &j = pass.triangle.vertices[(e + 1) % 3];
            expected[e] = i;
            Vertex& v = expected[3 + e];
            v.position = pass.new_vertex[e].position;
            v.normal = pass.edges[e].normal;
            v.tangent = pass.edges[e].tangent;
            v.texture = pass.new_vertex[e].texture;
            v.handedness = i.handedness == 1 && j.handedness == 1 ? std::int8_t{1} : std::int8_t{-1};
            const int generation = std::max(i.generation, j.generation) + 1;
            v.generation = static_cast<std::uint8_t>(std::min(generation, highest_generation));
            v.displaced_known = true;
            v.screen_normal_known = false;
            v.code = pass.new_vertex[e].code;
            v.displaced = pass.new_vertex[e].displaced;
            v.displaced_normal = pass.edges[e].displaced_normal;
            v.screen = pass.new_vertex[e].screen;
            if ((pass.split >> e & 1) != 0) {
                split_by |= pass.edges[e].tests & requesting_tests;
                saturated += generation > highest_generation ? 1 : 0;
            }
        }
        const ChildIndices indices =
            triangulate(pass.split, choose_second_diagonal(pass.split, choice, [&](std::uint8_t at) -> const Position& {
                            return expected[at].displaced;
                        }));

        std::vector<Triangle> children;
        CHECK(tessellate(pass, choice, formats, saturations,
                         [&](const Triangle& child) { children.push_back(child); }) == indices.count);
        if (children.size() != static_cast<std::size_t>(indices.count))
            FAIL(children.size() << " children, said to be " << indices.count);
        for (std::size_t c = 0; c < children.size(); ++c) {
            const Triangle& child = children[c];
            for (std::size_t v = 0; v < 3; ++v)
                if (!same_bits(child.vertices[v], expected[indices.children[c][v]]))
                    FAIL("split " << int{pass.split} << ", child " << c << ", vertex " << v);
            // Final edges: the parent's own edges that neither split nor ask to, whichever edges of the child they are.
            unsigned final_edges = 0;
            for (unsigned e = 0; e < 3; ++e)
                for (unsigned of_parent = 0; of_parent < 3; ++of_parent)
                    if ((pass.split >> of_parent & 1) == 0 && !split_decision(pass.edges[of_parent].tests) &&
                        indices.children[c][e] == of_parent && indices.children[c][(e + 1) % 3] == (of_parent + 1) % 3)
                        final_edges |= 1u << e;
            CHECK(child.final_edges == (formats.final_edges ? final_edges : 0));
            CHECK(child.parent == (pass.split == 0 ? pass.triangle.parent : pass.number));
            const bool whole = pass.split == 0;
            if (child.base != pass.triangle.base || child.finished != whole ||
                child.split_by != (whole ? int{pass.triangle.split_by} : split_by) ||
                child.stopped_by != (whole ? pass.triangle.stopped_by : 0))
                FAIL("split " << int{pass.split} << ", tags of child " << c);
        }
    }
    CHECK(saturated > 1000);
    CHECK(saturations.generation == saturated);
    CHECK(saturations.total() == saturated);
}

TEST_CASE("tessellate: in every child the sum of generations is greater than in its parent") {
    Random random(27);
    Saturations saturations;
    const auto sum = [](const Triangle& triangle) {
        int generations = 0;
        for (const Vertex& vertex : triangle.vertices)
            generations += vertex.generation;
        return generations;
    };
    for (int k = 0; k < 20'000; ++k) {
        TrianglePass pass = any_pass(random);
        pass.split = static_cast<std::uint8_t>(1 + k % 7);
        const auto choice = static_cast<Triangulation>(random.integer(0, 2));
        tessellate(pass, choice, Formats{}, saturations, [&](const Triangle& child) {
            if (sum(child) <= sum(pass.triangle))
                FAIL("split " << int{pass.split} << ": " << sum(child) << " after " << sum(pass.triangle));
        });
    }
    CHECK(saturations.generation == 0);
}

TEST_CASE("tessellate: edge k runs from vertex k to the next") {
    TrianglePass pass;
    for (std::size_t k = 0; k < 3; ++k)
        pass.triangle.vertices[k].position.x = static_cast<std::int32_t>(k);
    for (int k = 0; k < 3; ++k) {
        CHECK(pass.edge_begin(k).position.x == k);
        CHECK(pass.edge_end(k).position.x == (k + 1) % 3);
    }
}
