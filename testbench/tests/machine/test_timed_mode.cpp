#include <cstdint>
#include <string>

#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// Two modes, one mesh: with any timing, stalls, buffers and queue order, timed mode emits the bare datapath's
// triangles, bit for bit.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// About a thousand triangles of all sizes, and base triangles that do not split.
const std::string small = "map.width=64 map.height=64 tests.summed_height_threshold=0.2 ";

const std::string cylinder =
    "mesh.source=cylinder mesh.columns=8 mesh.rows=4 map.source=noise map.width=64 map.height=33 "
    "map.address_u=repeat displacement.scale=0.1 tests.view_threshold=24 ";

std::string stalls(int seed, int per_mille, int longest = 16) {
    return "timing.stalls_seed=" + std::to_string(seed) + " timing.stalls_per_mille=" + std::to_string(per_mille) +
           " timing.stalls_longest=" + std::to_string(longest) + " ";
}

std::string queue(const std::string& order, int capacity) {
    return "hardware.queue_order=" + order + " hardware.queue_capacity=" + std::to_string(capacity) + " ";
}

struct TimedMesh {
    std::string name;
    std::string job;
    std::string settings;
    std::uint64_t more_edges_than = 0;
};

const CaseTable meshes(
    "timed mesh: ",
    {
        TimedMesh{"half donut, the paper's design", "", "", 50'000},
        {"half donut, three tests units, four ports, stalls", "",
         "hardware.tests_units=3 timing.summed_height_table_ports=4 " + stalls(3, 200), 50'000},
        {"last in first out", small, "hardware.queue_order=lifo"},
        {"three tests units", small, "hardware.tests_units=3"},
        {"three tests units, four ports, last in first out, stalls", small,
         "hardware.tests_units=3 hardware.queue_order=lifo timing.summed_height_table_ports=4 " + stalls(11, 300)},
        {"two ports", small, "timing.summed_height_table_ports=2"},
        {"four ports, two banks, narrow", small,
         "timing.summed_height_table_ports=4 timing.summed_height_table_banks=2 "
         "timing.summed_height_table_width=3"},
        {"a cylinder in repeat, three tests units, stalls", cylinder, "hardware.tests_units=3 " + stalls(5, 400), 3000},
        {"a cylinder in repeat, a bilinear filter, stalls", cylinder,
         "hardware.displacement_filter=bilinear " + stalls(6, 300), 3000},

        {"random stalls, seed 1, 100 per mille", small, stalls(1, 100)},
        {"random stalls, seed 2, 300 per mille, up to 40 cycles", small, stalls(2, 300, 40)},
        {"random stalls, seed 3, 500 per mille, last in first out", small,
         "hardware.queue_order=lifo " + stalls(3, 500)},
        {"every item of every channel stalled", small, "hardware.tests_units=3 " + stalls(4, 1000, 5)},

        {"one place for an incomplete triangle", small, "timing.pass_or_tessellate_buffer=1 timing.results_buffer=1"},
        {"one place for an incomplete triangle, three tests units, stalls", small,
         "timing.pass_or_tessellate_buffer=1 timing.results_buffer=1 hardware.tests_units=3 " + stalls(8, 400)},
        {"large buffers everywhere", small,
         every_unit("buffer", 37) + every_table("buffer", 37) +
             "timing.results_buffer=37 hardware.queue_watermark=1000 " + stalls(9, 200)},
        {"intervals and latencies of all sizes", small,
         every_unit("latency", [](int k) { return 1 + (k + 1) * 7 % 13; }) +
             every_unit("interval", [](int k) { return 1 + (k + 1) * 5 % 11; }) + "hardware.transform_pipelines=3"},
        {"memories of latency 0", small, every_table("latency", 0)},
        {"memories of latency 300, 100 and 30", small,
         "timing.summed_height_table_latency=300 timing.displacement_map_latency=100 "
         "timing.normal_map_latency=30 hardware.tests_units=3"},
        {"tests switched off", small, "tests.summed_height=false tests.view=false " + stalls(12, 200)},

        {"a queue large enough never overflows", small, queue("lifo", 64) + "hardware.queue_overflow=error"},
        {"the watermark admits host triangles while fewer wait", small, "hardware.queue_watermark=40"},
    },
    [](const TimedMesh& row) {
        const CheckedRun run(with_settings(timed_job(), row.job + row.settings));
        CHECK(run.conformance.passed(0.5));
        CHECK(run.mesh.triangles.size() > 2 * run.setup.base_triangles.size());
        CHECK(run.pipeline.edges_tested() > row.more_edges_than);
    });

struct Spill {
    std::string name;
    std::string settings;
    std::size_t places;
};

const CaseTable spills(
    "timed mesh: ",
    {
        Spill{"first in first out, one place, spills", queue("fifo", 1), 1},
        {"first in first out, 8 places, spills and stalls", queue("fifo", 8) + stalls(21, 300), 8},
        {"first in first out, 64 places, spills to a slow memory",
         queue("fifo", 64) + "timing.off_chip_latency=500 timing.off_chip_bandwidth=3 timing.off_chip_buffer=1", 64},
        {"last in first out, one place, spills", queue("lifo", 1), 1},
        {"last in first out, 8 places, spills and stalls", queue("lifo", 8) + stalls(22, 300), 8},
        {"last in first out, 8 places, many host triangles, a fast memory",
         queue("lifo", 8) + "hardware.queue_watermark=200 timing.off_chip_latency=0 timing.off_chip_bandwidth=4096 "
                            "timing.off_chip_buffer=1",
         8},
    },
    [](const Spill& row) {
        const CheckedRun run(with_settings(timed_job(), small + row.settings));
        const TriangleQueue& its_queue = run.pipeline.triangle_queue;
        CHECK(its_queue.spilled() > 0);
        CHECK(its_queue.on_chip_high_water_mark() == row.places + 1);  // and one on its way out
        CHECK(its_queue.high_water_mark() > row.places + 1);
        CHECK(run.pipeline.off_chip_memory.bytes_written() % its_queue.spilled() == 0);
    });

}  // namespace

TEST_CASE("timed mesh: every item through its packed form, three tests units, a Highlight Test") {
    MachineSetup setup = setup_of(with_settings(timed_job(), small + "hardware.tests_units=3 tests.highlight=true"));
    setup.design.packed_streams = true;
    const CheckedRun run(setup);
    CHECK(run.mesh.triangles.size() > 2 * setup.base_triangles.size());
}

TEST_CASE("timed mesh: a cylinder in repeat, whose rectangles wrap") {
    const CheckedRun run(with_settings(timed_job(), cylinder));
    // up to nine entries for one that wraps
    CHECK(run.pipeline.height_table.transactions() > 12 * run.pipeline.edges_tested());
    CHECK(run.pipeline.edges_tested() > 3000);
}

TEST_CASE("timed mesh: culling") {
    const CheckedRun run(
        with_settings(timed_job(), small + "hardware.culling=back camera.eye=[0,-4,0.6] " + stalls(6, 100)));
    CHECK(run.counts.culled > 0);
    CHECK(run.simulation.rasteriser.triangles() > 0);
}

// Each split adds three triangles to the queue, net, along one path of at most 12 generations; some more passes, and
// their children, are in flight.
TEST_CASE("timed mesh: last in first out, 64 places: nothing is spilled") {
    const CheckedRun run(with_settings(timed_job(), small + queue("lifo", 64)));
    CHECK(run.pipeline.triangle_queue.spilled() == 0);
    CHECK(run.pipeline.triangle_queue.high_water_mark() <= 64);
    CHECK(run.pipeline.off_chip_memory.occupied_cycles() == 0);
}

// The same counts as without stalls; only the time differs.
TEST_CASE("timed mesh: stalls change the number of cycles and nothing else") {
    const CheckedRun run(with_settings(timed_job(), small + stalls(31, 300)));
    CHECK(run.pipeline.height_table.transactions() == 12 * run.pipeline.edges_tested());
    CHECK(run.simulation.cycles() > 36 * run.counts.passes + 17);
}
