#include "testbench/output/report/area.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/source_folder.h"
#include "testbench/tests/support/timed_checks.h"

// The hardware of a design: some units by hand, and the effect of each parameter.

using namespace tessera;
using namespace tessera::testing;

namespace {

std::map<std::string, UnitArea> area(const std::string& settings = "", std::size_t queue_places = 100) {
    const MachineSetup setup = setup_of(with_settings(timed_job(), settings));
    const std::vector<UnitArea> units = design_area(setup.design, setup.registers, queue_places);
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
    using M = Multiplications;
    CHECK(multiplications("normalise") == M::normalise);
    CHECK(multiplications("bump") + M::normalise == M::bump);
    CHECK(multiplications("displace") == M::displace);
    CHECK(multiplications("transform") == M::transform);
    CHECK(multiplications("transform_normal") == M::transform_normal);
    CHECK(multiplications("light") == M::light);
    CHECK(multiplications("faces_away") == M::faces_away);
    CHECK(multiplications("summed_height_limit") == M::summed_height_limit);
    CHECK(multiplications("highlight_test") == M::highlight_test);
}

// A screen point has 48 more bits for N' or N's, 16 for its code, 1 for a vertex's handedness, 2 for a longer tag.
TEST_CASE("area: a machine of families has the figures worked out by hand") {
    auto units = area("hardware.design=modern");
    CHECK(units["displace_vertex"].multipliers == 4 + 27);
    CHECK(units["displace_vertex"].register_bits == (204 + 51) + 7 * (300 + 67 + 16 + 48));
    CHECK(units["total"].multipliers == 31 + 24 + 51 + 12);
    CHECK(units["triangle_queue"].memory_bits == 100 * (1572 + 3 * 16 + 3 + 9 * 48));
    CHECK(units["transform"].register_bits == (300 + 67) + 20 * (381 + 67));
    CHECK(units["total"].ports == 2 + 2 + 16);
    auto two_tests = area("hardware.design=modern hardware.normal_tests=2");
    CHECK(two_tests["normal_test"].multipliers == 2 * 51);
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
    CHECK(units["displace_vertex"].multipliers == 12 + 4);
    CHECK(units["transform"].register_bits == 300 + 20 * 381);
    CHECK(units["transform"].multipliers == 15 + 9);
    CHECK(units["normal_test"].multipliers == 51);
    CHECK(units["lighting"].multipliers == 12);
    CHECK(units["tessellation"].register_bits == 2 * 2991);
    CHECK(units["triangle_queue"].memory_bits == 100 * 1572);
    CHECK(units["displacement_map"].memory_bits == 264 * 264 * 16);
    CHECK(units["normal_map"].memory_bits == 264 * 264 * 48);
    CHECK(units["summed_height_table"].memory_bits == 265 * 265 * 32);
    CHECK(units["summed_height_table"].ports == 1);
    CHECK(units["total"].multipliers == 16 + 24 + 51 + 12);
    CHECK(units["total"].ports == 3);
    std::uint64_t registers = 0;
    for (const auto& [name, unit] : units)
        registers += name == "total" ? 0 : unit.register_bits;
    CHECK(units["total"].register_bits == registers);
}

TEST_CASE("area: each parameter changes the expected figures") {
    auto paper = area();
    CHECK(area("timing.transform_interval=5")["transform"].multipliers == 5);
    CHECK(area("hardware.transform_pipelines=2")["transform"].multipliers == 48);
    CHECK(area("hardware.tests_units=3")["normal_test"].multipliers == 3 * 51);
    CHECK(area("hardware.displacement_filter=bilinear")["normal_test"].multipliers == 51 + 9);
    CHECK(area("hardware.displacement_filter=bilinear")["displace_vertex"].multipliers == 16 + 3);
    CHECK(area("tests.highlight=true")["normal_test"].multipliers == 51 + 9);
    CHECK(area("hardware.culling=back")["pass_or_tessellate"].multipliers == 2);
    CHECK(area("tests.summed_height_unit=area")["summed_height_test"].multipliers == 2);
    CHECK(area("timing.summed_height_table_ports=2 timing.summed_height_table_banks=8")["total"].ports == 18);
    CHECK(area("", 7)["triangle_queue"].memory_bits == 7 * 1572);
    CHECK(area("hardware.final_edges=true", 7)["triangle_queue"].memory_bits == 7 * 1575);
    CHECK(area("hardware.one_texel_from_map=true", 7)["triangle_queue"].memory_bits == 7 * (1572 + 48));
    auto first = area("hardware.test_order=cheap_first");
    CHECK(first.count("collect_tests") == 0);
    CHECK(first["sequence_tests"].register_bits > paper["collect_tests"].register_bits);
    const std::uint64_t one_edge_less =
        area("hardware.test_order=cheap_first timing.edges_in_sequence=31")["sequence_tests"].register_bits;
    CHECK(32 * (first["sequence_tests"].register_bits - one_edge_less) < first["sequence_tests"].register_bits);
    CHECK(first["sequence_tests"].register_bits - one_edge_less > 600);
    CHECK(paper["total"].multipliers == first["total"].multipliers);
    // A miss takes 40 cycles of latency and 4 of the channel longer, and needs as many more register stages.
    auto cached = area("timing.normal_map_cache_bytes=6000");
    CHECK(cached["normal_map"].memory_bits == 1000 * 48);
    const std::uint64_t more = cached["normal_test"].register_bits - paper["normal_test"].register_bits;
    CHECK(more % 44 == 0);
    CHECK(more / 44 > 400);
}

// 264 x 264 texels: 17 address bits. Three codes per request.
TEST_CASE("area: the second side of a displacement map has its own ports and addresses, its bits count once") {
    const std::string curvature = "hardware.height_test=curvature timing.displacement_map_buffer=2 ";
    auto units = area(curvature + "timing.displacement_map_ports=2 timing.displacement_map_banks=4");
    CHECK(units["displacement_map"].ports == 8);
    CHECK(units["displacement_map_for_tests"].ports == 8);
    CHECK(units["displacement_map"].memory_bits == 264 * 264 * 16);
    CHECK(units["displacement_map_for_tests"].memory_bits == 0);
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
    const UnitArea all = total_area(area_of(three)), one = total_area(design_area(setup.design, setup.registers, 40));
    CHECK(all.multipliers == 3 * one.multipliers);
    CHECK(all.register_bits == 3 * one.register_bits);
    CHECK(all.memory_bits == 3 * one.memory_bits);
    CHECK(all.ports == 3 * one.ports);
}
