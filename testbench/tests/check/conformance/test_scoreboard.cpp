#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "modules/datapath/rectangle.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/tests/check/conformance/scoreboard_cases.h"

using namespace tessera;
using namespace tessera::testing;

namespace {

/// Near the near plane w may already be the largest value of its format: a larger one wraps around.
template <class Value>
void move_around(Value& value, int by) {
    value = static_cast<Value>(std::int64_t{value} + by);
}

}  // namespace

TEST_CASE("the datapath conforms on random edges of many formats") {
    Random random(1);
    std::uint64_t flips = 0, behind = 0, diagonals = 0;
    for (const datapath::Formats& formats : many_formats()) {
        for (const Manner manner : {Manner::tame, Manner::wild}) {
            for (int design = 0; design < 60; ++design) {
                Case c(random, formats, manner);
                Scoreboard scoreboard(c.setup.registers, c.inputs);
                for (int k = 0; k < 100; ++k) {
                    const datapath::TrianglePass pass = c.pass(random);
                    for (const datapath::NewVertex& made : pass.new_vertex)
                        behind += made.screen.in_front ? 0 : 1;
                    scoreboard.write(pass);
                }
                const ConformanceResult result = scoreboard.result();
                INFO(result.first_mismatch);
                REQUIRE(result.mismatches == 0);
                for (const auto& q : result.quantities) {
                    INFO(q.name);
                    CHECK(q.outside == 0);
                    CHECK(q.worst_ratio <= 1);
                    CHECK(std::isfinite(q.max_bound));
                    CHECK(std::isfinite(q.rms_error));
                }
                flips += result.flipped_edges;
                diagonals += test(result, "diagonal").compared;
            }
        }
    }
    // The cases are a useful test only if they reach these corners.
    CHECK(flips > 100);
    CHECK(behind > 1000);
    CHECK(diagonals > 1000);
}

TEST_CASE("no bound is more than four times the largest error seen") {
    Random random(2);
    for (const datapath::Formats& formats :
         {datapath::Formats{}, make_formats(32, 31, 18, 16, 12, 16, 32, 20), make_formats(24, 12, 12, 10, 8, 12, 24, 8),
          make_formats(16, 8, 10, 8, 4, 8, 20, 8), bilinear(datapath::Formats{}),
          bilinear(make_formats(24, 12, 12, 10, 8, 12, 24, 8))}) {
        // One design at a time: a large error in one must not hide a loose bound in another.
        std::map<std::string, double> loosest;
        for (int design = 0; design < 10; ++design) {
            Case c(random, formats, Manner::tame);
            Scoreboard scoreboard(c.setup.registers, c.inputs);
            for (int k = 0; k < 20000; ++k)
                scoreboard.write(c.pass(random));
            const ConformanceResult result = scoreboard.result();
            INFO(result.first_mismatch);
            REQUIRE(result.mismatches == 0);
            for (const auto& q : result.quantities)
                if (q.max_bound > 0)
                    loosest[q.name] = std::max(loosest[q.name], q.max_bound / q.max_error);
        }
        std::string seen;
        for (const auto& [name, ratio] : loosest) {
            seen += "  " + name + " " + std::to_string(ratio);
            INFO(name);
            CHECK(ratio <= 4);
        }
        WARN("position " << formats.position.bits << ", normal " << formats.normal.bits
                         << " bits; largest bound / largest error:" << seen);
    }
}

TEST_CASE("a value beyond its bound is caught in every field") {
    using Pass = datapath::TrianglePass;
    struct Field {
        const char* name;
        const char* quantity;
        std::function<void(Pass&, int)> move;
    };
    const std::vector<Field> fields = {
        {"P_ij.x", "P_ij", [](Pass& p, int by) { p.new_vertex[0].position.x += by; }},
        {"P_ij.y", "P_ij", [](Pass& p, int by) { p.new_vertex[1].position.y += by; }},
        {"P_ij.z", "P_ij", [](Pass& p, int by) { p.new_vertex[2].position.z += by; }},
        {"mean.x", "(N_i+N_j)/2", [](Pass& p, int by) { p.new_vertex[0].mean_normal.x += by; }},
        {"mean.y", "(N_i+N_j)/2", [](Pass& p, int by) { p.new_vertex[1].mean_normal.y += by; }},
        {"mean.z", "(N_i+N_j)/2", [](Pass& p, int by) { p.new_vertex[2].mean_normal.z += by; }},
        {"t_ij.u", "t_ij", [](Pass& p, int by) { p.new_vertex[0].texture.u += static_cast<unsigned>(by); }},
        {"t_ij.v", "t_ij", [](Pass& p, int by) { p.new_vertex[1].texture.v += static_cast<unsigned>(by); }},
        {"tests' t_ij.u", "t_ij", [](Pass& p, int by) { p.edges[2].texture.u += static_cast<unsigned>(by); }},
        {"tests' t_ij.v", "t_ij", [](Pass& p, int by) { p.edges[0].texture.v += static_cast<unsigned>(by); }},
        {"N_ij.x", "N_ij", [](Pass& p, int by) { p.edges[0].normal.x += by; }},
        {"N_ij.y", "N_ij", [](Pass& p, int by) { p.edges[1].normal.y += by; }},
        {"N_ij.z", "N_ij", [](Pass& p, int by) { p.edges[2].normal.z += by; }},
        {"T_ij.x", "T_ij", [](Pass& p, int by) { p.edges[0].tangent.x += by; }},
        {"T_ij.y", "T_ij", [](Pass& p, int by) { p.edges[1].tangent.y += by; }},
        {"T_ij.z", "T_ij", [](Pass& p, int by) { p.edges[2].tangent.z += by; }},
        {"N'_ij.x", "N'_ij", [](Pass& p, int by) { p.edges[0].displaced_normal.x += by; }},
        {"N'_ij.y", "N'_ij", [](Pass& p, int by) { p.edges[1].displaced_normal.y += by; }},
        {"N'_ij.z", "N'_ij", [](Pass& p, int by) { p.edges[2].displaced_normal.z += by; }},
        {"P'_ij.x", "P'_ij", [](Pass& p, int by) { p.new_vertex[0].displaced.x += by; }},
        {"P'_ij.y", "P'_ij", [](Pass& p, int by) { p.new_vertex[1].displaced.y += by; }},
        {"P'_ij.z", "P'_ij", [](Pass& p, int by) { p.new_vertex[2].displaced.z += by; }},
        {"P's_ij.x", "P's_ij", [](Pass& p, int by) { p.new_vertex[0].screen.x += by; }},
        {"P's_ij.y", "P's_ij", [](Pass& p, int by) { p.new_vertex[1].screen.y += by; }},
        {"w_ij", "w_ij", [](Pass& p, int by) { move_around(p.new_vertex[2].screen.w, by); }},
        {"P'.x", "P'", [](Pass& p, int by) { p.triangle.vertices[0].displaced.x += by; }},
        {"P'.y", "P'", [](Pass& p, int by) { p.triangle.vertices[1].displaced.y += by; }},
        {"P'.z", "P'", [](Pass& p, int by) { p.triangle.vertices[2].displaced.z += by; }},
        {"N'.x", "N'", [](Pass& p, int by) { p.triangle.vertices[0].displaced_normal.x += by; }},
        {"N'.y", "N'", [](Pass& p, int by) { p.triangle.vertices[1].displaced_normal.y += by; }},
        {"N'.z", "N'", [](Pass& p, int by) { p.triangle.vertices[2].displaced_normal.z += by; }},
        {"P's.x", "P's", [](Pass& p, int by) { p.triangle.vertices[0].screen.x += by; }},
        {"P's.y", "P's", [](Pass& p, int by) { p.triangle.vertices[1].screen.y += by; }},
        {"w", "w", [](Pass& p, int by) { move_around(p.triangle.vertices[2].screen.w, by); }},
    };
    Random random(3);
    int unbounded = 0;
    for (const datapath::Formats& formats : {datapath::Formats{}, make_formats(24, 12, 12, 10, 8, 12, 24, 8)}) {
        Case c(random, formats, Manner::tame);
        for (int k = 0; k < 40; ++k) {
            Pass good = c.pass(random);
            good.new_vertices = 7;
            const ConformanceResult before = check(c, good);
            REQUIRE(before.mismatches == 0);
            for (const Field& field : fields) {
                // The bound is that of the pass's worst component, so this deviation exceeds it by at least one LSB. A
                // midpoint has a single correct value.
                const double bound = quantity(before, field.quantity).max_bound;
                const bool single = std::string(field.quantity) == "P_ij" || std::string(field.quantity) == "t_ij" ||
                                    std::string(field.quantity) == "(N_i+N_j)/2";
                // Near the near plane a screen position's bound may cover its whole format: no value exceeds it.
                if (bound > 1e6) {
                    ++unbounded;
                    continue;
                }
                const int beyond = single ? 1 : static_cast<int>(2 * bound) + 1;
                for (const int by : {beyond, -beyond}) {
                    INFO(field.name << " moved by " << by << ", bound " << bound);
                    Pass bad = good;
                    field.move(bad, by);
                    const ConformanceResult result = check(c, bad);
                    CHECK(quantity(result, field.quantity).outside == 1);
                    CHECK(result.mismatches >= 1);
                    CHECK_FALSE(result.passed(100));
                    CHECK(result.first_mismatch.find("hardware") != std::string::npos);
                }
            }
        }
    }
    CHECK(unbounded < 2 * 40);  // of 80 passes with some forty fields each
}

TEST_CASE("a flipped decision is caught") {
    Random random(4);
    std::uint64_t normal_caught = 0, normal_allowed = 0;
    for (int design = 0; design < 30; ++design) {
        Case c(random, datapath::Formats{}, Manner::tame);
        for (int k = 0; k < 10; ++k) {
            const datapath::TrianglePass good = c.pass(random);
            const auto flipped_bit = [&](datapath::TestBits bit) {
                datapath::TrianglePass bad = good;
                bad.edges[1].tests = static_cast<std::uint8_t>(bad.edges[1].tests ^ bit);
                return check(c, bad);
            };
            CHECK(test(flipped_bit(datapath::summed_height_bit), "SHT").mismatches == 1);
            CHECK(test(flipped_bit(datapath::view_bit), "VT").mismatches == 1);
            CHECK(test(flipped_bit(datapath::tex_coord_bit), "TCT").mismatches == 1);
            CHECK(test(flipped_bit(datapath::generation_bit), "GT").mismatches == 1);
            const ConformanceResult normal = flipped_bit(datapath::normal_bit);
            normal_caught += test(normal, "NT").mismatches;
            normal_allowed += test(normal, "NT").allowed_flips;

            datapath::TrianglePass other_split = good;
            other_split.split = static_cast<std::uint8_t>(other_split.split ^ 2);
            CHECK(test(check(c, other_split), "split").mismatches == 1);

            datapath::TrianglePass other_side = good;
            other_side.new_vertex[2].screen.in_front = !good.new_vertex[2].screen.in_front;
            CHECK(test(check(c, other_side), "in_front").mismatches == 1);
        }
    }
    // A bound of a few LSB in a range of 2^14 excuses almost no flip.
    CHECK(normal_caught + normal_allowed == 300);
    CHECK(normal_allowed <= 2);
}

TEST_CASE("an allowed flip of NT excuses the split that follows from it and no other") {
    Random random(5);
    int seen = 0;
    for (int design = 0; design < 2000 && seen < 20; ++design) {
        Case c(random, make_formats(24, 12, 8, 6, 8, 12, 20, 4), Manner::tame);
        c.setup.registers.tests.summed_height_test = false;
        c.setup.registers.tests.view_test = false;
        c.setup.registers.tests.tex_coord_test = false;
        c.setup.registers.tests.generation_test = false;
        Case plain(c.setup, Manner::tame);
        for (int k = 0; k < 10; ++k) {
            const datapath::TrianglePass pass = plain.pass(random);
            const ConformanceResult result = check(plain, pass);
            INFO(result.first_mismatch);
            REQUIRE(result.mismatches == 0);
            if (test(result, "NT").allowed_flips != 1 || result.edges != 3)
                continue;
            ++seen;
            CHECK(test(result, "split").allowed_flips == 1);
            CHECK(result.flipped_edges == 1);
            CHECK(result.passed(34));
            CHECK_FALSE(result.passed(33));
            // With all three inverted every split contradicts its edge's bits, on the flipped edge too.
            datapath::TrianglePass bad = pass;
            bad.split = static_cast<std::uint8_t>(bad.split ^ 7);
            CHECK(test(check(plain, bad), "split").mismatches == 3);
        }
    }
    CHECK(seen >= 20);
}

TEST_CASE("broken arithmetic is caught") {
    Random random(6);
    MachineSetup setup = Case::make_setup(random, datapath::Formats{}, Manner::tame);
    setup.registers.map = {90, 70, datapath::AddressMode::clamp, datapath::AddressMode::repeat};
    setup.map.geometry = setup.registers.map;
    setup.map.codes.clear();
    for (int k = 0; k < 90 * 70; ++k)
        setup.map.codes.push_back(static_cast<std::uint16_t>(random.natural(0, 65535)));
    setup.registers.tests.summed_height_unit = datapath::SummedHeightUnit::area;
    setup.registers.tests.height_thresholds[0] = 4000;
    setup.registers.tests.generation_limit = 3;
    Case c(setup, Manner::tame);
    const datapath::Registers& registers = c.setup.registers;
    const datapath::Formats& formats = registers.formats;

    const auto sabotaged = [&](const std::function<void(datapath::TrianglePass&, int)>& sabotage) {
        std::vector<datapath::TrianglePass> passes;
        for (int n = 0; n < 300; ++n) {
            datapath::TrianglePass pass = c.pass(random);
            for (int k = 0; k < 3; ++k)
                sabotage(pass, k);
            passes.push_back(pass);
        }
        return check(c, passes);
    };
    const auto set_summed_height = [](datapath::TrianglePass& pass, int k, bool value) {
        auto& tests = pass.edges[static_cast<std::size_t>(k)].tests;
        tests = static_cast<std::uint8_t>(value ? tests | datapath::summed_height_bit
                                                : tests & ~datapath::summed_height_bit);
    };
    const auto summed_height_with = [&](const datapath::TrianglePass& pass, int k, const datapath::RectangleSize& size,
                                        const std::function<std::uint64_t(const datapath::Rectangle&)>& sum) {
        const auto about = [&](const datapath::TexCoord& t) {
            return sum(datapath::centred_rectangle(t, size, registers.map, formats));
        };
        return datapath::summed_height_test(about(pass.edge_begin(k).texture), about(pass.edge_end(k).texture),
                                            about(pass.edges[static_cast<std::size_t>(k)].texture), size,
                                            registers.tests);
    };
    const auto right_sum = [&](const datapath::Rectangle& r) {
        std::uint64_t sum = 0;
        for (std::uint32_t y = r.first_row; y < r.last_row; ++y)
            for (std::uint32_t x = r.first_column; x < r.last_column; ++x)
                sum += c.setup.map.code(x % registers.map.width, y % registers.map.height);
        return sum;
    };

    SECTION("none") {
        CHECK(sabotaged([](datapath::TrianglePass&, int) {}).mismatches == 0);
        CHECK(sabotaged([&](datapath::TrianglePass& pass, int k) {
                  const auto size = datapath::rectangle_size(pass.edge_begin(k).texture, pass.edge_end(k).texture,
                                                             registers.map, formats);
                  set_summed_height(pass, k, summed_height_with(pass, k, size, right_sum));
              }).mismatches == 0);
    }
    SECTION("two corners of a rectangle swapped") {
        const auto prefix = [&](std::uint32_t x, std::uint32_t y) { return right_sum({0, x, 0, y}); };
        const auto result = sabotaged([&](datapath::TrianglePass& pass, int k) {
            const auto size =
                datapath::rectangle_size(pass.edge_begin(k).texture, pass.edge_end(k).texture, registers.map, formats);
            set_summed_height(pass, k, summed_height_with(pass, k, size, [&](const datapath::Rectangle& r) {
                                  return prefix(r.last_column, r.last_row) - prefix(r.first_column, r.last_row) +
                                         prefix(r.last_column, r.first_row) - prefix(r.first_column, r.first_row);
                              }));
        });
        CHECK(test(result, "SHT").mismatches > 10);
        CHECK(result.mismatches == test(result, "SHT").mismatches);
    }
    SECTION("a rectangle's shift off by one") {
        for (const int wrong : {-1, 1}) {
            const auto result = sabotaged([&](datapath::TrianglePass& pass, int k) {
                datapath::Formats shifted = formats;
                shifted.texture.fraction += wrong;
                const auto size = datapath::rectangle_size(pass.edge_begin(k).texture, pass.edge_end(k).texture,
                                                           registers.map, shifted);
                set_summed_height(pass, k, summed_height_with(pass, k, size, right_sum));
            });
            CHECK(test(result, "SHT").mismatches > 10);
        }
    }
    SECTION("a rectangle one texel off") {
        const auto result = sabotaged([&](datapath::TrianglePass& pass, int k) {
            const auto size =
                datapath::rectangle_size(pass.edge_begin(k).texture, pass.edge_end(k).texture, registers.map, formats);
            set_summed_height(pass, k, summed_height_with(pass, k, size, [&](datapath::Rectangle r) {
                                  ++r.first_row;
                                  ++r.last_row;
                                  return right_sum(r);
                              }));
        });
        CHECK(test(result, "SHT").mismatches > 10);
    }
    SECTION("midpoint rounded up") {
        const auto result = sabotaged([](datapath::TrianglePass& pass, int k) {
            pass.new_vertex[static_cast<std::size_t>(k)].position.x = static_cast<std::int32_t>(
                (std::int64_t{pass.edge_begin(k).position.x} + pass.edge_end(k).position.x + 1) >> 1);
        });
        CHECK(quantity(result, "P_ij").outside > 100);
    }
    SECTION("displacement shifted by one bit too few or too many") {
        for (const int wrong : {-1, 1}) {
            datapath::Formats shifted = formats;
            shifted.displacement.bits += wrong;
            const auto result = sabotaged([&](datapath::TrianglePass& pass, int k) {
                datapath::NewVertex& made = pass.new_vertex[static_cast<std::size_t>(k)];
                datapath::Saturations saturations;
                const std::uint32_t code =
                    c.setup.map.codes[c.inputs.map.texel(Dequantise(formats).texture(made.texture))];
                made.displaced = datapath::displace(made.position, pass.edges[static_cast<std::size_t>(k)].normal, code,
                                                    registers.displacement, shifted, saturations);
                made.screen = datapath::transform(made.displaced, registers.transform, formats, saturations);
            });
            CHECK(quantity(result, "P'_ij").outside > 100);
        }
    }
    SECTION("the texel beside the right one") {
        const auto result = sabotaged([&](datapath::TrianglePass& pass, int k) {
            datapath::TexCoord t = pass.new_vertex[static_cast<std::size_t>(k)].texture;
            t.u += 1u << formats.texture.fraction;
            pass.edges[static_cast<std::size_t>(k)].displaced_normal = c.machine.bumped(
                pass.edges[static_cast<std::size_t>(k)].normal, pass.edges[static_cast<std::size_t>(k)].tangent, 1, t);
        });
        CHECK(quantity(result, "N'_ij").outside > 100);
    }
    SECTION("bitangent with the wrong sign") {
        const auto result = sabotaged([&](datapath::TrianglePass& pass, int k) {
            pass.edges[static_cast<std::size_t>(k)].displaced_normal = c.machine.bumped(
                pass.edges[static_cast<std::size_t>(k)].normal, pass.edges[static_cast<std::size_t>(k)].tangent, -1,
                pass.edges[static_cast<std::size_t>(k)].texture);
        });
        CHECK(quantity(result, "N'_ij").outside > 100);
    }
    SECTION("the mean normal not normalised") {
        const auto result = sabotaged([](datapath::TrianglePass& pass, int k) {
            pass.edges[static_cast<std::size_t>(k)].normal = pass.new_vertex[static_cast<std::size_t>(k)].mean_normal;
        });
        CHECK(quantity(result, "N_ij").outside > 100);
    }
}

TEST_CASE("broken arithmetic between texels is caught") {
    Random random(9);
    MachineSetup setup = Case::make_setup(random, bilinear(datapath::Formats{}), Manner::tame);
    setup.registers.displacement = {1 << 28, 0};
    Case c(setup, Manner::tame);
    const datapath::Registers& registers = c.setup.registers;
    const datapath::Formats& formats = registers.formats;
    /// Counts P'_ij outside their bounds when displaced by the code that code_at(t) returns.
    const auto displaced_with = [&](const auto& code_at) {
        std::vector<datapath::TrianglePass> passes;
        for (int n = 0; n < 200; ++n) {
            datapath::TrianglePass pass = c.pass(random);
            for (std::size_t k = 0; k < 3; ++k) {
                datapath::NewVertex& made = pass.new_vertex[k];
                datapath::Saturations unused;
                made.displaced = datapath::displace(made.position, pass.edges[k].normal, code_at(made.texture),
                                                    registers.displacement, formats, unused);
                made.screen = datapath::transform(made.displaced, registers.transform, formats, unused);
            }
            passes.push_back(pass);
        }
        return quantity(check(c, passes), "P'_ij").outside;
    };
    const auto code_at = [&](const datapath::TexCoord& t, int fraction) {
        std::array<std::int64_t, 4> codes{};
        std::size_t count = 0;
        datapath::map_entries(t, {0, registers.map.width, registers.map.height, 1}, registers.map, formats,
                              [&](std::uint64_t index) { codes.at(count++) = c.setup.map.codes[index]; });
        return datapath::interpolate(codes, datapath::bilinear_weights(t, formats), fraction, formats);
    };
    CHECK(displaced_with([&](datapath::TexCoord t) { return static_cast<std::uint32_t>(code_at(t, 8)); }) == 0);
    // Wrong codes: rounded down, rounded to whole codes, interpolated with a weight one LSB off.
    CHECK(displaced_with([&](datapath::TexCoord t) { return static_cast<std::uint32_t>(code_at(t, 24) >> 16); }) > 100);
    CHECK(displaced_with([&](datapath::TexCoord t) { return static_cast<std::uint32_t>(code_at(t, 0) << 8); }) > 100);
    CHECK(displaced_with([&](datapath::TexCoord t) {
              return static_cast<std::uint32_t>(code_at({t.u ^ 1u, t.v}, 8));
          }) > 100);
}

TEST_CASE("a wrong diagonal is caught") {
    Random random(7);
    MachineSetup setup = Case::make_setup(random, datapath::Formats{}, Manner::tame);
    setup.registers.triangulation = datapath::Triangulation::shorter;
    Case c(setup, Manner::tame);
    datapath::Registers broken = c.setup.registers;
    broken.triangulation = datapath::Triangulation::second;
    Scoreboard right(c.setup.registers, c.inputs), wrong(broken, c.inputs);
    for (int k = 0; k < 1000; ++k) {
        datapath::TrianglePass pass = c.pass(random);
        right.write(pass);
        wrong.write(pass);
    }
    const auto compared = test(right.result(), "diagonal").compared;
    REQUIRE(compared > 50);
    CHECK(test(right.result(), "diagonal").agreed == compared);
    const auto mismatches = test(wrong.result(), "diagonal").mismatches;
    CHECK(mismatches > compared / 4);
    CHECK(mismatches < compared * 3 / 4);
    CHECK(wrong.result().first_mismatch.find("P' of vertex") != std::string::npos);
}

TEST_CASE("a constant map never splits by height, and conforms") {
    Random random(8);
    for (const datapath::Formats& formats : many_formats()) {
        MachineSetup setup = Case::make_setup(random, formats, Manner::tame);
        setup.map.codes.assign(setup.map.codes.size(), static_cast<std::uint16_t>(setup.map.highest_code()));
        setup.registers.tests.height_thresholds[0] = 0;
        Case c(setup, Manner::tame);
        std::vector<datapath::TrianglePass> passes;
        for (int k = 0; k < 200; ++k) {
            passes.push_back(c.pass(random));
            for (const datapath::EdgeTests& edge : passes.back().edges)
                CHECK((edge.tests & datapath::summed_height_bit) == 0);
        }
        const ConformanceResult result = check(c, passes);
        INFO(result.first_mismatch);
        CHECK(result.mismatches == 0);
        CHECK(test(result, "SHT").agreed == 600);
    }
}

TEST_CASE("near the near plane hardware and golden model differ only within the rounding of w") {
    Random random(9);
    std::uint64_t flips = 0, flipped_edges = 0, in_front = 0, behind = 0;
    for (int design = 0; design < 400; ++design) {
        MachineSetup setup = Case::make_setup(random, make_formats(20, 8, 8, 6, 8, 12, 24, 8), Manner::tame);
        // Looks along +x from the origin; the near plane lies among the midpoints.
        const std::int64_t one = std::int64_t{1} << datapath::TransformParameters::matrix_fraction;
        const std::int32_t near = 5000;
        setup.registers.transform.row_w = {one, 0, 0, 0};
        setup.registers.transform.near_plane = one * near;
        Case c(setup, Manner::tame);
        for (int k = 0; k < 20; ++k) {
            datapath::TrianglePass pass = c.pass(random);
            const auto move = [&](datapath::Vertex& v) {
                v.position.x = near + random.integer32(-3, 3) - (v.displaced.x - v.position.x);
            };
            for (datapath::Vertex& v : pass.triangle.vertices)
                move(v);
            pass = c.evaluate(pass.triangle, true);
            for (const datapath::Vertex& v : pass.triangle.vertices)
                ++(v.screen.in_front ? in_front : behind);
            const ConformanceResult result = check(c, pass);
            INFO(result.first_mismatch);
            REQUIRE(result.mismatches == 0);
            flips += test(result, "in_front").allowed_flips;
            // Without the base vertices every flip belongs to an edge, and is counted once.
            pass.new_vertices = 0;
            const ConformanceResult edges = check(c, pass);
            CHECK(edges.flipped_edges >= test(edges, "in_front").allowed_flips);
            flipped_edges += test(edges, "in_front").allowed_flips;
        }
    }
    CHECK(in_front > 1000);
    CHECK(behind > 1000);
    CHECK(flips > 0);
    CHECK(flipped_edges > 0);
}

TEST_CASE("a vertex not in front of the near plane has no screen position") {
    Random random(10);
    MachineSetup setup = Case::make_setup(random, datapath::Formats{}, Manner::tame);
    setup.registers.transform.near_plane = std::int64_t{1} << 60;
    Case c(setup, Manner::tame);
    datapath::TrianglePass pass = c.pass(random);
    CHECK(check(c, pass).mismatches == 0);
    pass.new_vertex[1].screen.x = 1;
    CHECK(check(c, pass).mismatches == 1);
}

TEST_CASE("normals and tangents of length zero stay zero in hardware and golden model") {
    Random random(11);
    for (const datapath::Formats& formats : many_formats()) {
        Case c(random, formats, Manner::tame);
        const auto with = [&](const std::function<void(datapath::Triangle&)>& change) {
            datapath::TrianglePass pass = c.pass(random);
            change(pass.triangle);
            return c.evaluate(pass.triangle, true);
        };
        const auto opposite = [](const datapath::Direction& d) { return datapath::Direction{-d.x, -d.y, -d.z}; };
        const std::vector<datapath::TrianglePass> passes = {
            with([](datapath::Triangle& t) {
                for (datapath::Vertex& v : t.vertices)
                    v.normal = v.tangent = {};
            }),
            with([](datapath::Triangle& t) {
                for (datapath::Vertex& v : t.vertices)
                    v.normal = {};
            }),
            with([](datapath::Triangle& t) {
                for (datapath::Vertex& v : t.vertices)
                    v.tangent = {};
            }),
            with([&](datapath::Triangle& t) {
                t.vertices[1].normal = opposite(t.vertices[0].normal);
                t.vertices[1].tangent = opposite(t.vertices[0].tangent);
            }),
            with([&](datapath::Triangle& t) {
                t.vertices[1].normal = opposite(t.vertices[0].normal);
                t.vertices[1].normal.x += 1;  // the mean is half an LSB: rounded down to zero
                t.vertices[1].tangent = opposite(t.vertices[0].tangent);
                t.vertices[1].tangent.y -= 1;  // rounded down to one
            }),
        };
        for (const datapath::TrianglePass& pass : passes) {
            const ConformanceResult result = check(c, pass);
            INFO(result.first_mismatch);
            CHECK(result.mismatches == 0);
        }
        // A value that is zero in both models must be exactly zero.
        datapath::TrianglePass bad = passes[0];
        bad.edges[0].normal.x = 1;
        CHECK(quantity(check(c, bad), "N_ij").outside == 1);
        bad = passes[0];
        bad.edges[0].displaced_normal.z = 1;
        CHECK(quantity(check(c, bad), "N'_ij").outside == 1);
        bad = passes[3];
        bad.edges[0].normal.y = 1;
        CHECK(quantity(check(c, bad), "N_ij").outside == 1);
    }
}

TEST_CASE("a saturated value is compared with the saturated golden value") {
    Random random(12);
    MachineSetup setup = Case::make_setup(random, datapath::Formats{}, Manner::tame);
    const datapath::Format& position = setup.registers.formats.position;
    setup.registers.displacement = {0, static_cast<std::int32_t>(position.highest)};
    Case c(setup, Manner::tame);
    datapath::TrianglePass pass = c.pass(random);
    for (datapath::Vertex& v : pass.triangle.vertices) {
        v.position.x = static_cast<std::int32_t>(position.highest - 10);
        v.normal = {1 << 14, 0, 0};
    }
    pass = c.evaluate(pass.triangle, true);
    REQUIRE(pass.new_vertex[0].displaced.x == position.highest);
    const ConformanceResult result = check(c, pass);
    INFO(result.first_mismatch);
    CHECK(result.mismatches == 0);
    pass.new_vertex[0].displaced.x -= 1;
    CHECK(quantity(check(c, pass), "P'_ij").outside == 1);
}

TEST_CASE("the first mismatch is reported with all operands") {
    Random random(13);
    Case c(random, datapath::Formats{}, Manner::tame);
    datapath::TrianglePass pass = c.pass(random);
    pass.triangle.base = 77;
    pass.new_vertex[1].position.y += 1;
    pass.new_vertex[2].position.z -= 1;
    const ConformanceResult result = check(c, pass);
    CHECK(result.mismatches == 2);
    const std::string& text = result.first_mismatch;
    CHECK(text.rfind("P_ij.y: hardware " + std::to_string(pass.new_vertex[1].position.y), 0) == 0);
    for (const char* part : {"base triangle 77, edge 1", "i: P (", "j: P (", "T (", "handedness", "generation", "N'_ij",
                             "golden:", "lengths before normalising", "near plane", "formats"}) {
        INFO(part);
        CHECK(text.find(part) != std::string::npos);
    }
}
