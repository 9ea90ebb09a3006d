#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "modules/datapath/height_tests.h"
#include "modules/datapath/rank_view.h"
#include "testbench/setup/tables/rank_table.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// Designs with another height test in place of the Summed Height Test: closed, equal to the bare recursion's mesh bit for
// bit, every decision and cut golden's within its bound, nothing lost; with the host's tables and with random bits.

using namespace tessera;
using namespace tessera::testing;

namespace {

const std::string alone = "map.width=60 map.height=44 tests.normal=false tests.view=false ",
                  lattice = "mesh.source=lattice mesh.spacing=16 ",
                  curvature = alone + "hardware.height_test=curvature tests.curvature_threshold=0.02 ",
                  mipmap = alone + "hardware.height_test=mipmap tests.mipmap_threshold=0.01 ",
                  rank = alone + lattice +
                         "hardware.height_test=rank hardware.triangulation=greatest_rank tests.rank_threshold=0.002 "
                         "tests.bound_threshold=0.002 ";

MachineSetup setup_with(const std::string& test, const std::string& settings) {
    return setup_of(with_settings(timed_job(), test + settings));
}

/// With the Curvature Test short edges read codes. Each edge that a Rank Test evaluates, and that has a midpoint on the
/// lattice, reads one entry: CheckedRun compares the counts.
void check_design(const MachineSetup& setup, std::uint64_t least_splits) {
    const CheckedRun run(setup);
    REQUIRE(run.counts.edges_split > least_splits);
    const Totals totals(run.simulation);
    CHECK(totals.height_table_reads > 0);
    const bool by_codes = setup.registers.formats.height_test == datapath::number_of<datapath::CurvatureTest>();
    CHECK((totals.evaluated.summed_height_by_codes > 0) == by_codes);
    run.expect_closed_in_texture();
}

const std::string repeated = "map.address_u=repeat map.address_v=repeat ", functional = "mode=functional ",
                  cheap_first = "hardware.test_order=cheap_first ", final_edges = "hardware.final_edges=true ",
                  modern = "hardware.design=modern ", other_tests = "tests.normal=true tests.view=true ",
                  slow_cached_table =
                      "timing.height_table_cache_bytes=256 timing.height_table_latency=9 "
                      "timing.height_test_latency=7 timing.height_test_interval=2 ";

/// What every height test has: a name, settings, and designs that concern it alone.
struct HeightTestRows {
    std::string name, settings;
    std::vector<SettingsRow> own;
};

std::vector<SettingsRow> rows_of(const std::vector<HeightTestRows>& tests) {
    const std::vector<SettingsRow> shared{
        {"the paper's design", ""},
        {"alongside the other tests, functional",
         functional + other_tests + "tests.highlight=true hardware.culling=back"},
        {"three tests units, random stalls", "hardware.tests_units=3 " + random_stalls(3, 300, 20)},
        {"cheap tests first, final edges, alongside the other tests, a slow table behind a cache, random stalls",
         cheap_first + final_edges + other_tests + slow_cached_table + random_stalls(5, 300, 20)},
        {"families", "hardware.work=family"},
        {"the modern design, functional", modern + functional},
        {"the modern design, alongside the other tests, a queue of one place that spills, random stalls",
         modern + other_tests + "tests.highlight=true hardware.queue_capacity=1 " + random_stalls(3, 300, 20)},
        {"three modern machines", modern + "hardware.machines=3"},
    };
    std::vector<SettingsRow> rows;
    for (const HeightTestRows& test : tests)
        for (const std::vector<SettingsRow>& its : {shared, test.own})
            for (const SettingsRow& row : its)
                rows.push_back({test.name + ", " + row.name, test.settings + row.settings});
    return rows;
}

const CaseTable designs(
    "with a ",
    rows_of({
        {"Curvature Test",
         curvature,
         {{"a lattice wider than the map", lattice},
          {"a repeated map", repeated},
          {"interpolated heights", "hardware.displacement_filter=bilinear"},
          {"fitted heights, read by short edges", "map.heights=fitted"},
          {"a slow displacement map", "timing.displacement_map_latency=30"}}},
        {"Mipmap Test",
         mipmap,
         {{"a lattice wider than the map", lattice},
          {"a repeated map, maximum filter", repeated + "tests.mipmap_filter=maximum tests.mipmap_threshold=0.05"},
          {"the modern design, four banks, fitted heights",
           modern + "timing.height_table_banks=4 map.heights=fitted"}}},
        {"Rank Test",
         rank,
         {{"ranks of 6 bits", "formats.rank_bits=6"},
          {"ranks of 16 bits", "formats.rank_bits=16"},
          {"bounds alone", "formats.rank_bits=0 formats.bound_bits=8"},
          {"families, functional, ranks and bounds",
           "hardware.work=family mode=functional formats.rank_bits=12 formats.bound_bits=10"},
          {"all splitting edges cut at once", "hardware.triangulation=shorter"},
          {"the modern design, all splitting edges cut at once", modern + "hardware.triangulation=shorter"},
          {"limited by the Generation Test", "tests.generation_limit=5"},
          {"cheap tests first, of the other tests only the Highlight Test, buffers for one edge",
           cheap_first + "tests.highlight=true timing.edges_in_sequence=1 timing.results_buffer=1"},
          {"view-dependent", cheap_first + "tests.rank_view=per_point tests.rank_threshold=2"},
          {"view-dependent per pixel, final edges, alongside the other tests, random stalls",
           cheap_first + final_edges + other_tests + "tests.rank_view=per_pixel tests.rank_threshold=6 " +
               random_stalls(5, 300, 20)},
          {"view-dependent bounds, functional, entries of 6 bits",
           cheap_first + functional +
               "tests.rank_view=per_point tests.bound_threshold=1 formats.rank_bits=0 formats.bound_bits=6"},
          {"view-dependent ranks and bounds, three tests units, eye inside the scene",
           cheap_first +
               "hardware.tests_units=3 tests.rank_view=per_pixel tests.rank_threshold=50 tests.bound_threshold=20 "
               "formats.bound_bits=8 camera.eye=[0.1,0.2,0.15] camera.target=[0.5,0.4,0]"},
          {"the modern design, view-dependent ranks and bounds, narrow positions",
           modern + "tests.rank_view=per_point tests.rank_threshold=2 tests.bound_threshold=2 formats.bound_bits=16 "
                    "formats.position_bits=20 formats.position_fraction=6"}}},
    }),
    [](const SettingsRow& row) { check_design(setup_with(row.settings, ""), 100); });

/// Crack freedom does not depend on the table's content.
MachineSetup with_random_curvatures(MachineSetup setup) {
    std::mt19937_64 random(7);
    for (std::uint64_t& entry : setup.curvature_table.entries)
        entry = random() >> (64 - datapath::curvature_entry_bits);
    setup.registers.tests.height_thresholds[0] = 1u << 17;
    return setup;
}

MachineSetup with_random_ranks(MachineSetup setup, unsigned seed) {
    std::mt19937 random(seed);
    const datapath::Formats& formats = setup.registers.formats;
    for (std::uint16_t& entry : setup.rank_tables.rank)
        entry = static_cast<std::uint16_t>(random() % (1u << formats.rank_bits));
    for (std::uint16_t& entry : setup.rank_tables.bound)
        entry = static_cast<std::uint16_t>(random() % (1u << formats.bound_bits));
    for (std::uint8_t& entry : setup.rank_tables.radius)
        entry = static_cast<std::uint8_t>(random() % 200);
    setup.registers.tests.height_thresholds[datapath::rank_number] = (1 << formats.rank_bits) / 3;
    setup.registers.tests.height_thresholds[datapath::bound_number] = (1 << formats.bound_bits) / 2;
    if (formats.distances) {  // so that at the mesh's centre the same entries ask for a split
        const auto level = static_cast<std::int32_t>(datapath::distance_level(
            2 * std::uint64_t{datapath::eye_distance({}, setup.registers.transform, formats)}));
        setup.registers.tests.height_thresholds[datapath::rank_number] = 65536 / 3 - level;
        setup.registers.tests.height_thresholds[datapath::bound_number] = 65536 / 2 - level / 2;
    }
    return setup;
}

const CaseTable random_curvatures("a Curvature Table of random bits: ",
                                  {
                                      SettingsRow{"the paper's design", ""},
                                      {"cheap tests first, final edges", cheap_first + final_edges},
                                      {"the modern design, functional, a repeated map", modern + functional + repeated},
                                  },
                                  [](const SettingsRow& row) {
                                      check_design(with_random_curvatures(setup_with(curvature, row.settings)), 500);
                                  });

const CaseTable random_ranks(
    "a Rank Table of random bits: ",
    {
        SettingsRow{"the paper's design", "formats.bound_bits=6"},
        {"all splitting edges cut at once", "hardware.triangulation=shorter"},
        {"cheap tests first, final edges", cheap_first + final_edges},
        {"the modern design", modern + "formats.rank_bits=12 formats.bound_bits=12"},
        {"view-dependent", cheap_first + "tests.rank_view=per_pixel formats.rank_bits=9 formats.bound_bits=7"},
        {"the modern design with view-dependent bounds, functional",
         modern + functional + "tests.rank_view=per_point formats.rank_bits=0 formats.bound_bits=12"},
    },
    [](const SettingsRow& row) { check_design(with_random_ranks(setup_with(rank, row.settings), 7), 500); });

/// How the map's readers are connected.
struct SidesRow {
    std::string name;
    std::string settings;
    bool two_sides;
};

const CaseTable sides("sides of the displacement map: ",
                      {
                          SidesRow{"a Curvature Test has its own", "", true},
                          {"three Curvature Tests share one", "hardware.tests_units=3", true},
                          {"a Curvature Test of the modern design has its own", "hardware.design=modern", true},
                          {"only one behind a cache", "timing.displacement_map_cache_bytes=1024", false},
                          {"only one with a Summed Height Test",
                           "hardware.height_test=summed_height hardware.one_texel_from_map=true tests.normal=true",
                           false},
                      },
                      [](const SidesRow& row) {
                          const CheckedRun run(setup_with(curvature, row.settings));
                          const Machine& p = run.machine;
                          REQUIRE((p.displacement_map_for_tests != nullptr) == row.two_sides);
                          const sc_core::sc_object* first = &p.displacement_map;
                          if (p.displacement_map_cache)
                              first = p.displacement_map_cache.get();
                          const sc_core::sc_object* second = row.two_sides ? p.displacement_map_for_tests.get() : first;
                          CHECK(p.displace_vertex.displacement_map.memory() == first);
                          for (const TessellationTests& tests : p.tessellation_tests)
                              CHECK(tests.height_test.displacement_map->memory() == second);
                          CHECK(Totals(run.simulation).evaluated.summed_height_by_codes > 0);
                          if (row.two_sides)
                              CHECK(3 * p.displacement_map_for_tests->activity().items_in() ==
                                    p.displacement_map_for_tests->transactions());
                      });

const CaseTable idle("a disabled height test reads nothing and splits nothing: ",
                     {
                         SettingsRow{"Curvature Test", curvature},
                         {"Mipmap Test", mipmap},
                         {"Rank Test", rank},
                     },
                     [](const SettingsRow& row) {
                         const CheckedRun run(setup_with(row.settings, "tests.summed_height=false"));
                         CHECK(run.counts.edges_split == 0);
                         CHECK(Totals(run.simulation).height_table_reads == 0);
                     });

}  // namespace

TEST_CASE("a Rank Test whose threshold is the greatest rank splits nothing", "[rank]") {
    MachineSetup setup = setup_with(rank, functional);
    setup.registers.tests.height_thresholds[datapath::rank_number] =
        *std::max_element(setup.rank_tables.rank.begin(), setup.rank_tables.rank.end());
    const CheckedRun run(setup);
    CHECK(run.counts.edges_split == 0);
}
