#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/tests/check/conformance/scoreboard_cases.h"

using namespace tessera;
using namespace tessera::testing;

TEST_CASE("a diagonal other than the golden model's is caught for each pair of split edges") {
    using datapath::Triangulation;
    // For each pair of split edges the remaining quadrilateral, of vertices 0 to 2 and midpoints 3 + k of edges k.
    const std::map<unsigned, std::array<unsigned, 4>> quadrilaterals{
        {3, {0, 3, 4, 2}}, {5, {3, 1, 2, 5}}, {6, {0, 1, 4, 5}}};
    Random random(8);
    std::map<std::pair<unsigned, bool>, int> seen;
    for (int design = 0; design < 60; ++design) {
        MachineSetup setup = Case::make_setup(random, datapath::Formats{}, Manner::tame);
        setup.registers.triangulation = Triangulation::shorter;
        for (bool datapath::TestParameters::*test :
             {&datapath::TestParameters::summed_height_test, &datapath::TestParameters::view_test,
              &datapath::TestParameters::tex_coord_test, &datapath::TestParameters::generation_test})
            setup.registers.tests.*test = false;
        Case c(setup, Manner::tame);
        for (int k = 0; k < 50; ++k) {
            const datapath::TrianglePass pass = c.pass(random);
            const auto with = [&](Triangulation hardware) {
                datapath::Registers registers = c.setup.registers;
                registers.triangulation = hardware;
                Scoreboard scoreboard(registers, c.inputs);
                scoreboard.write(pass);
                return scoreboard.result();
            };
            const auto found = quadrilaterals.find(pass.split);
            if (found == quadrilaterals.end()) {
                CHECK(test(with(Triangulation::shorter), "diagonal").compared == 0);
                continue;
            }
            const auto length = [&](unsigned a, unsigned b) {
                const auto corner = [&](unsigned index) {
                    return index < 3 ? pass.triangle.vertices[index].displaced : pass.new_vertex[index - 3].displaced;
                };
                const datapath::Position from = corner(a), to = corner(b);
                return std::abs(std::int64_t{from.x} - to.x) + std::abs(std::int64_t{from.y} - to.y) +
                       std::abs(std::int64_t{from.z} - to.z);
            };
            const auto& q = found->second;
            // The second diagonal only if it is shorter by more than 1/64.
            const bool second = 64 * length(q[1], q[3]) < 63 * length(q[0], q[2]);
            ++seen[{pass.split, second}];
            INFO("split " << unsigned{pass.split} << ", second diagonal " << second);
            const ConformanceResult right = with(second ? Triangulation::second : Triangulation::first);
            CHECK(test(right, "diagonal").compared == 1);
            CHECK(right.mismatches == 0);
            const ConformanceResult wrong = with(second ? Triangulation::first : Triangulation::second);
            CHECK(wrong.mismatches == 1);
            CHECK(test(wrong, "diagonal").mismatches == 1);
            CHECK(wrong.first_mismatch.find("diagonal (diagonal of") != std::string::npos);
        }
    }
    CHECK(seen.size() == 6);
    for (const auto& [which, times] : seen)
        CHECK(times > 3);
}

TEST_CASE("each wrong decision of each edge is one mismatch under its own name") {
    const std::vector<std::pair<datapath::TestBits, std::string>> tests = {{datapath::normal_bit, "NT"},
                                                                           {datapath::summed_height_bit, "SHT"},
                                                                           {datapath::view_bit, "VT"},
                                                                           {datapath::tex_coord_bit, "TCT"},
                                                                           {datapath::generation_bit, "GT"}};
    Random random(9);
    int behind = 0, wrong = 0, excused = 0;
    for (int design = 0; design < 40; ++design) {
        Case c(random, datapath::Formats{}, design % 2 == 0 ? Manner::tame : Manner::wild);
        for (int n = 0; n < 5; ++n) {
            const datapath::TrianglePass good = c.pass(random);
            const ConformanceResult before = check(c, good);
            REQUIRE(before.mismatches == 0);
            const auto one_of = [&](const datapath::TrianglePass& bad, const std::string& name) {
                INFO(name);
                const ConformanceResult result = check(c, bad);
                INFO(result.first_mismatch);
                // A flip within the bound around the threshold is no mismatch.
                if (test(before, name).allowed_flips + test(result, name).allowed_flips > 0) {
                    ++excused;
                    return;
                }
                ++wrong;
                CHECK(result.mismatches == 1);
                CHECK(test(result, name).mismatches == 1);
                CHECK(result.first_mismatch.find(name + " (") != std::string::npos);
            };
            for (unsigned k = 0; k < 3; ++k) {
                INFO("edge " << k);
                for (const auto& [bit, name] : tests) {
                    datapath::TrianglePass bad = good;
                    bad.edges[k].tests = static_cast<std::uint8_t>(bad.edges[k].tests ^ bit);
                    one_of(bad, name);
                }
                datapath::TrianglePass bad = good;
                bad.split = static_cast<std::uint8_t>(bad.split ^ 1u << k);
                one_of(bad, "split");

                const datapath::ScreenPosition& screen = good.new_vertex[k].screen;
                bad = good;
                bad.new_vertex[k].screen.in_front = !screen.in_front;
                if (screen.in_front)
                    bad.new_vertex[k].screen.x = bad.new_vertex[k].screen.y = 0;
                one_of(bad, "in_front");
                if (screen.in_front)
                    continue;
                ++behind;
                for (std::int32_t datapath::ScreenPosition::*axis :
                     {&datapath::ScreenPosition::x, &datapath::ScreenPosition::y}) {
                    bad = good;
                    bad.new_vertex[k].screen.*axis = 1;
                    const ConformanceResult result = check(c, bad);
                    CHECK(result.mismatches == 1);
                    CHECK(result.first_mismatch.find("not in front of the near plane") != std::string::npos);
                }
            }
        }
    }
    CHECK(behind > 20);
    CHECK(excused * 100 < wrong);
}

TEST_CASE("a final edge: only the golden model's decision not to split it is compared") {
    Random random(11);
    int whole = 0, split = 0;
    for (int design = 0; design < 60; ++design) {
        Case c(random, datapath::Formats{}, Manner::tame);
        for (int k = 0; k < 50; ++k) {
            datapath::TrianglePass pass = c.pass(random);
            pass.new_vertices = 0;
            const datapath::EdgeTests tested = pass.edges[0];
            const bool splits = (pass.split & 1) != 0;
            // Skipped: with other splits, leaving this one out would also change the diagonal.
            if (splits && ((tested.tests & datapath::summed_height_bit) == 0 || pass.split != 1))
                continue;
            pass.triangle.final_edges = 1;
            pass.edges[0] = {};
            pass.new_vertex[0] = {};
            pass.split = static_cast<std::uint8_t>(pass.split & ~1);
            Scoreboard scoreboard(c.setup.registers, c.inputs);
            scoreboard.write(pass);
            const ConformanceResult result = scoreboard.result();
            INFO(result.first_mismatch);
            CHECK(result.edges == 2);
            CHECK(result.mismatches == (splits ? 1 : 0));  // only the Summed Height Test would split it; it is exact
            CHECK(test(result, "split").mismatches == (splits ? 1 : 0));
            ++(splits ? split : whole);
        }
    }
    CHECK(whole > 100);
    CHECK(split > 20);
}

TEST_CASE("a split edge's N, T, N' are compared even if the machine reports no evaluated test") {
    Random random(13);
    int split = 0;
    for (int k = 0; k < 300; ++k) {
        Case c(random, datapath::Formats{}, Manner::tame);
        datapath::TrianglePass pass = c.pass(random);
        if ((pass.split & 1) == 0)
            continue;
        pass.edges[0].evaluated = 0;
        pass.edges[0].normal = {};
        Scoreboard scoreboard(c.setup.registers, c.inputs);
        scoreboard.write(pass);
        CHECK(scoreboard.result().mismatches > 0);
        ++split;
    }
    CHECK(split > 20);
}

TEST_CASE("a test that was not evaluated is not compared, and the decision of the others is") {
    Random random(12);
    int left_out = 0;
    for (int design = 0; design < 60; ++design) {
        Case c(random, datapath::Formats{}, Manner::tame);
        for (int k = 0; k < 50; ++k) {
            datapath::TrianglePass pass = c.pass(random);
            datapath::EdgeTests& edge = pass.edges[0];
            const unsigned tests = edge.tests;
            if ((tests & datapath::gating_tests) == datapath::gating_tests)
                continue;
            // As Sequence Tests does: the gating tests decide, the two others are not evaluated.
            edge = {};
            edge.texture = pass.new_vertex[0].texture;
            edge.evaluated = datapath::gating_tests;
            edge.tests = static_cast<std::uint8_t>(tests & datapath::gating_tests);
            Scoreboard scoreboard(c.setup.registers, c.inputs);
            scoreboard.write(pass);
            const ConformanceResult result = scoreboard.result();
            INFO(result.first_mismatch);
            CHECK(result.mismatches == 0);
            CHECK(test(result, "NT").compared == 2);
            CHECK(test(result, "SHT").compared == 2);
            CHECK(test(result, "VT").compared == 3);
            ++left_out;
        }
    }
    CHECK(left_out > 100);
}
