#include "testbench/output/report/area.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/bump.h"
#include "modules/datapath/cull.h"
#include "modules/datapath/displace.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/light.h"
#include "modules/datapath/normalise.h"
#include "modules/datapath/transform.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/source_folder.h"
#include "testbench/tests/support/timed_checks.h"

// The hardware of a design: some units by hand, and the effect of each parameter.

using namespace tessera;
using namespace tessera::testing;

namespace {

std::map<std::string, UnitArea> area(const std::string& settings = "") {
    const MachineSetup setup = setup_of(with_settings(timed_job(), settings));
    const Machine machine(sc_core::sc_gen_unique_name("machine"), setup.registers, setup.design);
    const std::vector<UnitArea> units = area_of(machine.units());
    std::map<std::string, UnitArea> by_name;
    for (const UnitArea& unit : units)
        by_name[unit.name] = unit;
    REQUIRE(by_name.size() == units.size());
    by_name["total"] = total_area(units);
    return by_name;
}

/// The number N of "N x" in a function's row in the datapath's README.
unsigned multiplications(const std::string& function) {
    std::ifstream readme(source_folder() / "modules/datapath/README.md");
    for (std::string line; std::getline(readme, line);) {
        std::smatch found;
        if (line.rfind("| `" + function + "`", 0) == 0 &&
            std::regex_search(line, found, std::regex(R"((\d+) x[,;| ])")))
            return static_cast<unsigned>(std::stoul(found[1]));
    }
    return 0;
}

}  // namespace

TEST_CASE("area: the multiplications of each function are those of the datapath's README") {
    const datapath::Formats f;
    const datapath::Formats bilinear = [] {
        datapath::Formats formats;
        formats.filter = datapath::MapFilter::bilinear;
        return formats;
    }();
    for (const auto& [function, list] : std::vector<std::pair<std::string, datapath::Multiplications>>{
             {"normalise", normalise_multiplications(f, 16)},
             {"displace", displace_multiplications(f)},
             {"transform", transform_multiplications(f)},
             {"transform_normal", transform_normal_multiplications(f)},
             {"light", light_multiplications(f)},
             {"faces_away", faces_away_multiplications(f)},
             {"summed_height_limit", summed_height_limit_multiplications(f)},
             {"highlight_test", highlight_test_multiplications(f)},
             {"interpolate", interpolate_multiplications(bilinear)}}) {
        INFO(function);
        CHECK(multiplications(function) == list.size());
    }
    CHECK(multiplications("bump") + normalise_multiplications(f, 16).size() == bump_multiplications(f).size());
}

// Displace: S times a code, (S d + bias) times a normal's component; Transform: matrix entries of 26 bits, the reciprocal's
// two steps and two quotients; normals by rows.
TEST_CASE("area: multipliers are counted by the widths of their operands") {
    using Widths = std::map<datapath::OperandWidths, std::uint64_t>;
    auto units = area();
    CHECK(units["transform"].multipliers == Widths{{{32, 26}, 9}, {{33, 32}, 4}, {{33, 31}, 2}, {{16, 16}, 9}});
    CHECK(units["transform"].partial_product_bits() == 9 * 32 * 26 + 4 * 33 * 32 + 2 * 33 * 31 + 9 * 256);
    CHECK(units["displace_vertex"].multipliers ==
          Widths{{{32, 16}, 1 + 3}, {{33, 16}, 3}, {{16, 16}, 3}, {{32, 32}, 4}, {{32, 31}, 2}});
    CHECK(units["lighting"].multipliers == Widths{{{16, 16}, 9}, {{18, 9}, 3}});
    CHECK(units["total"].partial_product_bits() > units["normal_test"].partial_product_bits());
    auto narrow = area("formats.normal_bits=6 formats.normal_fraction=4");
    CHECK(narrow["transform"].multipliers[{6, 6}] == 9);
    CHECK(narrow["transform"].multiplier_count() == 24);
    CHECK(narrow["normal_test"].partial_product_bits() < units["normal_test"].partial_product_bits());
    // One multiplier serves five multiplications, and fits the widest of them.
    CHECK(area("timing.transform_interval=5")["transform"].multipliers ==
          Widths{{{33, 32}, 1}, {{33, 31}, 1}, {{32, 26}, 1}, {{16, 16}, 2}});
    CHECK(area("tests.summed_height_unit=area")["summed_height_test"].multipliers ==
          Widths{{{12, 11}, 1}, {{23, 19}, 1}});
    CHECK(area("hardware.height_test=curvature")["curvature_test"].multipliers == Widths{{{4, 4}, 3}, {{8, 7}, 3}});
}

// Of an entry or address: powers of two, where one bit more would be one too many, and their neighbours.
TEST_CASE("area: an address has the bits that number a table's entries") {
    for (const auto& [width, height, bits] : std::vector<std::array<unsigned, 3>>{
             {8, 8, 6}, {16, 16, 8}, {16, 15, 8}, {16, 17, 9}, {1, 2, 1}, {1, 1, 1}, {64, 1, 6}, {65, 1, 7}}) {
        CAPTURE(width, height);
        auto units = area("map.width=" + std::to_string(width) + " map.height=" + std::to_string(height));
        CHECK(units["displacement_map"].register_bits == bits);
        CHECK(units["normal_map"].register_bits == bits);
    }
    // A border of one entry on two sides.
    CHECK(area("map.width=7 map.height=7")["summed_height_table"].register_bits == 4 * 6);
    CHECK(area("map.width=8 map.height=8")["summed_height_table"].register_bits == 4 * 7);
}

// A bank with p ports is p copies of it; banks divide the entries.
TEST_CASE("area: each port of a bank takes a copy of its entries") {
    for (const char* const name : {"displacement_map", "normal_map", "summed_height_table"}) {
        const std::string key = std::string("timing.") + name;
        const std::uint64_t one = area()[name].memory_bits;
        CHECK(area(key + "_ports=2")[name].memory_bits == 2 * one);
        CHECK(area(key + "_ports=8")[name].memory_bits == 8 * one);
        CHECK(area(key + "_banks=8")[name].memory_bits == one);
        CHECK(area(key + "_banks=4 " + key + "_ports=3")[name].memory_bits == 3 * one);
        const std::string cached = key + "_cache_bytes=3072 " + key + "_line_bytes=48 ";
        CHECK(area(cached + key + "_ports=2")[name].memory_bits == 2 * area(cached)[name].memory_bits);
    }
}

// Lines of 64 bytes, sets of four: 320 and 448 bytes are 256, 1000 bytes are 768; the whole table needs no more.
TEST_CASE("area: a cache counts with the bits that are built") {
    const auto bits = [](const std::string& settings) {
        return area("timing.summed_height_table_cache_" + settings)["summed_height_table"].memory_bits;
    };
    for (const auto& [asked, built] : std::vector<std::pair<int, unsigned>>{
             {1, 64}, {64, 64}, {191, 128}, {256, 256}, {320, 256}, {448, 256}, {511, 256}, {512, 512}, {1000, 768}})
        CHECK(std::pair(asked, bits("bytes=" + std::to_string(asked))) == std::pair(asked, std::uint64_t{8} * built));
    const std::uint64_t lines = (265 * 265 * 4 + 63) / 64;
    CHECK(bits("bytes=1073741824") == lines * 64 * 8);
    CHECK(bits("bytes=300000 timing.summed_height_table_cache_ways=64") == lines * 64 * 8);
}

// A screen point has 48 more bits for N' or N's, 16 for its code, 1 for a vertex's handedness, 2 for a longer tag.
TEST_CASE("area: a machine of families has the figures worked out by hand") {
    auto units = area("hardware.design=modern");
    CHECK(units["displace_vertex"].multiplier_count() == 4 + 27);
    CHECK(units["displace_vertex"].register_bits == (204 + 51) + 7 * (300 + 67 + 16 + 48));
    CHECK(units["total"].multiplier_count() == 31 + 24 + 51 + 12);
    const std::uint64_t triangle = 1572 + 3 * 16 + 3 + 9 * 48;
    CHECK(area("hardware.design=modern hardware.queue_capacity=7")["triangle_queue"].memory_bits == 7 * triangle);
    CHECK(units["transform"].register_bits == (300 + 67) + 20 * (381 + 67));
    CHECK(units["total"].ports == 2 + 2 + 16);
    auto two_tests = area("hardware.design=modern hardware.normal_tests=2");
    CHECK(two_tests["normal_test"].multiplier_count() == 2 * 51);
    auto one_lane = area("hardware.design=modern hardware.edge_lanes=1");
    CHECK(units["view_test"].register_bits == 3 * one_lane["view_test"].register_bits);
    CHECK(units["tex_coord_test"].register_bits == 3 * one_lane["tex_coord_test"].register_bits);
    // An entry of Pass or Tessellate: a family and nine edges of some 300 bits.
    const std::uint64_t place =
        units["pass_or_tessellate"].register_bits -
        area("hardware.design=modern timing.pass_or_tessellate_buffer=95")["pass_or_tessellate"].register_bits;
    CHECK(place > 6 * 520 + 9 * 250);
    CHECK(place < 6 * 540 + 9 * 350);
}

// A base point has 6 + 4 + 96 + 48 + 50 = 204 bits, a displaced one 96 more, a screen point 81 more than that.
TEST_CASE("area: the default design has the figures worked out by hand") {
    auto units = area();
    // buffer of one; latency 6 and 1 of the map; a code of 16 bits
    CHECK(units["displace_vertex"].register_bits == 204 + 7 * (300 + 16));
    CHECK(units["displace_vertex"].multiplier_count() == 12 + 4);
    CHECK(units["transform"].register_bits == 300 + 20 * 381);
    CHECK(units["transform"].multiplier_count() == 15 + 9);
    CHECK(units["normal_test"].multiplier_count() == 51);
    CHECK(units["lighting"].multiplier_count() == 12);
    CHECK(units["tessellation"].register_bits == 2 * 2991);
    CHECK(units["triangle_queue"].memory_bits == 0);  // unbounded
    CHECK(units["displacement_map"].memory_bits == 264 * 264 * 16);
    CHECK(units["normal_map"].memory_bits == 264 * 264 * 48);
    CHECK(units["summed_height_table"].memory_bits == 265 * 265 * 32);
    CHECK(units["summed_height_table"].ports == 1);
    CHECK(units["total"].multiplier_count() == 16 + 24 + 51 + 12);
    CHECK(units["total"].ports == 3);
    std::uint64_t registers = 0;
    for (const auto& [name, unit] : units)
        registers += name == "total" ? 0 : unit.register_bits;
    CHECK(units["total"].register_bits == registers);
}

TEST_CASE("area: each parameter changes the expected figures") {
    auto paper = area();
    CHECK(area("timing.transform_interval=5")["transform"].multiplier_count() == 5);
    CHECK(area("hardware.transform_pipelines=2")["transform"].multiplier_count() == 48);
    CHECK(area("hardware.tests_units=3")["normal_test"].multiplier_count() == 3 * 51);
    CHECK(area("hardware.displacement_filter=bilinear")["normal_test"].multiplier_count() == 51 + 9);
    CHECK(area("hardware.displacement_filter=bilinear")["displace_vertex"].multiplier_count() == 16 + 3);
    CHECK(area("tests.highlight=true")["normal_test"].multiplier_count() == 51 + 9);
    CHECK(area("hardware.culling=back")["pass_or_tessellate"].multiplier_count() == 2);
    CHECK(area("tests.summed_height_unit=area")["summed_height_test"].multiplier_count() == 2);
    CHECK(area("timing.summed_height_table_ports=2 timing.summed_height_table_banks=8")["total"].ports == 18);
    CHECK(area("hardware.queue_capacity=7")["triangle_queue"].memory_bits == 7 * 1572);
    CHECK(area("hardware.queue_capacity=7 hardware.final_edges=true")["triangle_queue"].memory_bits == 7 * 1575);
    CHECK(area("hardware.queue_capacity=7 hardware.one_texel_from_map=true")["triangle_queue"].memory_bits ==
          7 * (1572 + 48));
    auto first = area("hardware.test_order=cheap_first");
    CHECK(first.count("collect_tests") == 0);
    CHECK(first["sequence_tests"].register_bits > paper["collect_tests"].register_bits);
    const std::uint64_t one_edge_less =
        area("hardware.test_order=cheap_first timing.edges_in_sequence=31")["sequence_tests"].register_bits;
    CHECK(32 * (first["sequence_tests"].register_bits - one_edge_less) < first["sequence_tests"].register_bits);
    CHECK(first["sequence_tests"].register_bits - one_edge_less > 600);
    CHECK(paper["total"].multiplier_count() == first["total"].multiplier_count());
    // A miss takes 40 cycles of latency and 4 of the channel longer, and needs as many more register stages.
    auto cached = area("timing.normal_map_cache_bytes=6000");
    CHECK(cached["normal_map"].memory_bits == 6000 * 8);  // 25 sets of 4 lines of 10 entries
    const std::uint64_t more = cached["normal_test"].register_bits - paper["normal_test"].register_bits;
    CHECK(more % 44 == 0);
    CHECK(more / 44 > 400);
}

// 264 x 264 texels: 17 address bits. Three codes per request.
TEST_CASE("area: the second side of a displacement map has its own ports, addresses and copies") {
    const std::string curvature = "hardware.height_test=curvature timing.displacement_map_buffer=2 ";
    auto units = area(curvature + "timing.displacement_map_ports=2 timing.displacement_map_banks=4");
    CHECK(units["displacement_map"].ports == 8);
    CHECK(units["displacement_map_for_tests"].ports == 8);
    CHECK(units["displacement_map"].memory_bits == 2 * 264 * 264 * 16);
    CHECK(units["displacement_map_for_tests"].memory_bits == 2 * 264 * 264 * 16);
    CHECK(units["displacement_map"].register_bits == 2 * 1 * 17);
    CHECK(units["displacement_map_for_tests"].register_bits == 2 * 3 * 17);
    CHECK(units["total"].ports == 8 + 8 + 1 + 1);
    for (const char* const shared : {"timing.displacement_map_cache_bytes=4096", "hardware.height_test=summed_height",
                                     "hardware.height_test=mipmap"})
        CHECK(area(curvature + shared).count("displacement_map_for_tests") == 0);
}

TEST_CASE("area: three machines have three times the hardware of one") {
    MachineSetup setup = setup_of(with_settings(timed_job(), "hardware.queue_capacity=40"));
    setup.machines = 3;
    const Simulation three(setup, 1000);
    const UnitArea all = total_area(area_of(three)), one = total_area(area_of(three.machine.units()));
    CHECK(all.multiplier_count() == 3 * one.multiplier_count());
    CHECK(all.register_bits == 3 * one.register_bits);
    CHECK(all.memory_bits == 3 * one.memory_bits);
    CHECK(all.ports == 3 * one.ports);
}
