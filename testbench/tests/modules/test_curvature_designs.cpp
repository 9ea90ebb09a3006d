#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <string>

#include "modules/datapath/height_tests.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// Designs with a Curvature or a Mipmap Test in place of the Summed Height Test: closed, the bare recursion's mesh bit
// for bit, decisions golden's within their bounds, nothing lost; with the host's table and with random bits.

using namespace tessera;
using namespace tessera::testing;

namespace {

const char* const alone =
    "map.width=60 map.height=44 hardware.height_test=curvature tests.normal=false tests.view=false "
    "tests.curvature_threshold=0.02";

MachineSetup curved(const std::string& settings) {
    return setup_of(with_settings(with_settings(timed_job(), alone), settings));
}

/// Crack freedom does not depend on the table's content.
MachineSetup with_random_table(MachineSetup setup) {
    std::mt19937_64 random(7);
    for (std::uint64_t& entry : setup.curvature_table.entries)
        entry = random() >> (64 - datapath::curvature_entry_bits);
    setup.registers.tests.height_thresholds[0] = 1u << 17;
    return setup;
}

/// With the Curvature Test short edges read codes.
void check_design(const MachineSetup& setup, std::uint64_t least_splits) {
    const CheckedRun run(setup);
    REQUIRE(run.counts.edges_split > least_splits);
    const Totals totals(run.simulation);
    CHECK(totals.height_table_reads > 0);
    const bool curvature = setup.registers.formats.height_test == datapath::number_of<datapath::CurvatureTest>();
    CHECK((totals.evaluated.summed_height_by_codes > 0) == curvature);
    run.expect_closed_in_texture();
}

struct Row {
    std::string name;
    std::string settings;
};

const CaseTable designs(
    "with a Curvature Test, ",
    {
        Row{"the paper's design", ""},
        {"functional", "mode=functional"},
        {"a lattice wider than the map", "mesh.source=lattice mesh.spacing=16"},
        {"a repeated map", "map.address_u=repeat map.address_v=repeat"},
        {"interpolated heights", "hardware.displacement_filter=bilinear"},
        {"fitted heights, read by short edges", "map.heights=fitted"},
        {"alongside the other tests", "tests.normal=true tests.view=true tests.highlight=true hardware.culling=back"},
        {"three tests units, random stalls",
         "hardware.tests_units=3 timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"final edges", "hardware.final_edges=true"},
        {"cheap tests first, final edges, alongside the other tests, random stalls",
         "hardware.test_order=cheap_first hardware.final_edges=true tests.normal=true tests.view=true "
         "timing.stalls_seed=5 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"cheap tests first, functional", "hardware.test_order=cheap_first mode=functional"},
        {"a slow table behind a cache",
         "timing.height_table_cache_bytes=256 timing.height_table_latency=9 timing.height_test_latency=7 "
         "timing.height_test_interval=2"},
        {"a slow displacement map", "timing.displacement_map_latency=30"},
        {"families", "hardware.work=family"},
        {"the modern design", "hardware.design=modern"},
        {"the modern design, functional", "hardware.design=modern mode=functional"},
        {"the modern design, alongside the other tests",
         "hardware.design=modern tests.normal=true tests.view=true tests.highlight=true"},
        {"the modern design, a queue of one place that spills, random stalls",
         "hardware.design=modern hardware.queue_capacity=1 timing.stalls_seed=3 timing.stalls_per_mille=300 "
         "timing.stalls_longest=20"},
        {"three modern machines", "hardware.design=modern hardware.machines=3"},
    },
    [](const Row& row) { check_design(curved(row.settings), 100); });

const char* const mipmap = "hardware.height_test=mipmap tests.mipmap_threshold=0.01 ";

const CaseTable mipmap_designs(
    "with a Mipmap Test, ",
    {
        Row{"the paper's design", ""},
        {"functional, maximum filter", "mode=functional tests.mipmap_filter=maximum"},
        {"a lattice wider than the map", "mesh.source=lattice mesh.spacing=16"},
        {"a repeated map, maximum filter",
         "map.address_u=repeat map.address_v=repeat tests.mipmap_filter=maximum tests.mipmap_threshold=0.05"},
        {"three tests units, random stalls",
         "hardware.tests_units=3 timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"cheap tests first, final edges, alongside the other tests, a slow table behind a cache",
         "hardware.test_order=cheap_first hardware.final_edges=true tests.normal=true tests.view=true "
         "timing.height_table_cache_bytes=256 timing.height_table_latency=9 timing.height_test_interval=2"},
        {"the modern design, four banks", "hardware.design=modern timing.height_table_banks=4"},
        {"three modern machines, fitted heights", "hardware.design=modern hardware.machines=3 map.heights=fitted"},
    },
    [](const Row& row) { check_design(curved(mipmap + row.settings), 100); });

const CaseTable random_tables("a Curvature Table of random bits: ",
                              {
                                  Row{"the paper's design", ""},
                                  {"cheap tests first, final edges",
                                   "hardware.test_order=cheap_first hardware.final_edges=true"},
                                  {"the modern design", "hardware.design=modern"},
                                  {"the modern design, functional, a repeated map",
                                   "hardware.design=modern mode=functional map.address_u=repeat map.address_v=repeat"},
                              },
                              [](const Row& row) { check_design(with_random_table(curved(row.settings)), 500); });

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
                          const CheckedRun run(curved(row.settings));
                          const Pipeline& p = run.pipeline;
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

const CaseTable off("a disabled height test reads nothing and splits nothing: ",
                    {
                        Row{"Curvature Test", ""},
                        {"Mipmap Test", mipmap},
                    },
                    [](const Row& row) {
                        const CheckedRun run(curved(row.settings + " tests.summed_height=false"));
                        CHECK(run.counts.edges_split == 0);
                        CHECK(Totals(run.simulation).height_table_reads == 0);
                    });

}  // namespace
