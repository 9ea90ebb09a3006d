#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "modules/datapath/rank_view.h"
#include "testbench/setup/tables/rank_table.h"
#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// Designs with a Rank Test in place of the Summed Height Test: closed, equal to the bare recursion's mesh bit for bit,
// every decision and cut golden's, nothing lost; with the host's tables and with tables of random bits.

using namespace tessera;
using namespace tessera::testing;

namespace {

const char* const on_a_lattice =
    "mesh.source=lattice mesh.spacing=16 map.width=60 map.height=44 hardware.height_test=rank "
    "hardware.triangulation=greatest_rank tests.normal=false tests.view=false tests.rank_threshold=0.002 "
    "tests.bound_threshold=0.002";

MachineSetup ranked(const std::string& settings) {
    return setup_of(with_settings(with_settings(timed_job(), on_a_lattice), settings));
}

/// Crack freedom does not depend on the tables' content.
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

/// Exactly one read of the Rank Table for each edge that the test evaluates and that has a midpoint on the lattice:
/// CheckedRun compares the counts.
void check_design(const MachineSetup& setup, std::uint64_t least_splits) {
    const CheckedRun run(setup);
    REQUIRE(run.counts.edges_split > least_splits);
    CHECK(Totals(run.simulation).height_table_reads > 0);
    run.expect_closed_in_texture();
}

struct Row {
    std::string name;
    std::string settings;
};

const CaseTable designs(
    "with a Rank Test, ",
    {
        Row{"the paper's design", ""},
        {"functional", "mode=functional"},
        {"ranks of 6 bits", "formats.rank_bits=6"},
        {"ranks of 16 bits", "formats.rank_bits=16"},
        {"bounds alone", "formats.rank_bits=0 formats.bound_bits=8"},
        {"ranks and bounds", "formats.rank_bits=12 formats.bound_bits=10"},
        {"all splitting edges cut at once", "hardware.triangulation=shorter"},
        {"alongside the other tests", "tests.normal=true tests.view=true tests.highlight=true hardware.culling=back"},
        {"limited by the Generation Test", "tests.generation_limit=5"},
        {"cheap tests first, of the other tests only the Highlight Test",
         "hardware.test_order=cheap_first tests.highlight=true"},
        {"three tests units, random stalls",
         "hardware.tests_units=3 timing.stalls_seed=3 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"final edges", "hardware.final_edges=true"},
        {"cheap tests first, final edges", "hardware.test_order=cheap_first hardware.final_edges=true"},
        {"cheap tests first, final edges, alongside the other tests, random stalls",
         "hardware.test_order=cheap_first hardware.final_edges=true tests.normal=true tests.view=true "
         "timing.stalls_seed=5 timing.stalls_per_mille=300 timing.stalls_longest=20"},
        {"cheap tests first, functional", "hardware.test_order=cheap_first mode=functional"},
        {"cheap tests first, buffers for one edge",
         "hardware.test_order=cheap_first timing.edges_in_sequence=1 timing.results_buffer=1"},
        {"a slow table behind a cache",
         "timing.height_table_cache_bytes=256 timing.height_table_latency=9 timing.height_test_latency=7 "
         "timing.height_test_interval=2"},
        {"families", "hardware.work=family"},
        {"families, functional, ranks and bounds", "hardware.work=family mode=functional formats.bound_bits=8"},
        {"the modern design", "hardware.design=modern"},
        {"the modern design, all splitting edges cut at once", "hardware.design=modern hardware.triangulation=shorter"},
        {"the modern design, alongside the other tests",
         "hardware.design=modern tests.normal=true tests.view=true tests.highlight=true"},
        {"the modern design, a queue of one place that spills, random stalls",
         "hardware.design=modern hardware.queue_capacity=1 timing.stalls_seed=3 timing.stalls_per_mille=300 "
         "timing.stalls_longest=20"},
        {"three modern machines", "hardware.design=modern hardware.machines=3"},
        {"view-dependent", "hardware.test_order=cheap_first tests.rank_view=per_point tests.rank_threshold=2"},
        {"view-dependent, functional, entries of 6 bits",
         "hardware.test_order=cheap_first mode=functional tests.rank_view=per_point tests.rank_threshold=2 "
         "formats.rank_bits=6"},
        {"view-dependent per pixel, final edges, alongside the other tests, random stalls",
         "hardware.test_order=cheap_first hardware.final_edges=true tests.normal=true tests.view=true "
         "tests.rank_view=per_pixel tests.rank_threshold=6 timing.stalls_seed=5 timing.stalls_per_mille=300 "
         "timing.stalls_longest=20"},
        {"view-dependent bounds",
         "hardware.test_order=cheap_first tests.rank_view=per_point tests.bound_threshold=1 formats.rank_bits=0 "
         "formats.bound_bits=12"},
        {"view-dependent ranks and bounds, three tests units, eye inside the scene",
         "hardware.test_order=cheap_first hardware.tests_units=3 tests.rank_view=per_pixel tests.rank_threshold=50 "
         "tests.bound_threshold=20 formats.bound_bits=8 camera.eye=[0.1,0.2,0.15] camera.target=[0.5,0.4,0]"},
        {"the modern design, view-dependent ranks and bounds",
         "hardware.design=modern tests.rank_view=per_point tests.rank_threshold=2 tests.bound_threshold=1 "
         "formats.bound_bits=16"},
        {"the modern design, view-dependent, functional, narrow positions",
         "hardware.design=modern mode=functional tests.rank_view=per_point tests.rank_threshold=2 "
         "tests.bound_threshold=2 formats.bound_bits=8 formats.position_bits=20 formats.position_fraction=6"},
    },
    [](const Row& row) { check_design(ranked(row.settings), 100); });

const CaseTable random_tables(
    "a Rank Table of random bits: ",
    {
        Row{"the paper's design", "formats.bound_bits=6"},
        {"all splitting edges cut at once", "hardware.triangulation=shorter"},
        {"cheap tests first, final edges", "hardware.test_order=cheap_first hardware.final_edges=true"},
        {"the modern design", "hardware.design=modern formats.rank_bits=12 formats.bound_bits=12"},
        {"the modern design, functional", "hardware.design=modern mode=functional"},
        {"view-dependent",
         "hardware.test_order=cheap_first tests.rank_view=per_pixel formats.rank_bits=9 formats.bound_bits=7"},
        {"the modern design with view-dependent bounds",
         "hardware.design=modern tests.rank_view=per_point formats.rank_bits=0 formats.bound_bits=12"},
    },
    [](const Row& row) { check_design(with_random_ranks(ranked(row.settings), 7), 500); });

}  // namespace

TEST_CASE("a Rank Table splits and reads nothing on a base mesh off the lattice", "[rank]") {
    // Corners at whole multiples of 11 texels: no edge is of even length.
    const CheckedRun run(ranked("mesh.source=plane mesh.columns=4 mesh.rows=4 map.width=44 map.height=44"));
    CHECK(run.counts.edges_split == 0);
    CHECK(Totals(run.simulation).height_table_reads == 0);
}

TEST_CASE("a Rank Test that is off reads nothing", "[rank]") {
    const CheckedRun run(ranked("tests.summed_height=false tests.normal=true"));
    CHECK(run.counts.edges_split > 0);
    CHECK(Totals(run.simulation).height_table_reads == 0);
}

TEST_CASE("a Rank Test whose threshold is the greatest rank splits nothing", "[rank]") {
    MachineSetup setup = ranked("mode=functional");
    setup.registers.tests.height_thresholds[datapath::rank_number] =
        *std::max_element(setup.rank_tables.rank.begin(), setup.rank_tables.rank.end());
    const CheckedRun run(setup);
    CHECK(run.counts.edges_split == 0);
}
