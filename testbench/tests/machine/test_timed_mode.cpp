#include <cstdint>
#include <string>

#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// Two modes, one mesh: with any timing, stalls, buffers and queue order, timed mode emits the bare datapath's
// triangles, bit for bit. Random cases draw all of these at once; here each stands out.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// About a thousand triangles of all sizes, and base triangles that do not split.
const std::string small = "map.width=64 map.height=64 tests.summed_height_threshold=0.2 ";

const std::string cylinder =
    "mesh.source=cylinder mesh.columns=8 mesh.rows=4 map.source=noise map.width=64 map.height=33 "
    "map.address_u=repeat displacement.scale=0.1 tests.view_threshold=24 ";

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
        {"three tests units, four ports, last in first out, stalls", small,
         "hardware.tests_units=3 hardware.queue_order=lifo timing.summed_height_table_ports=4 " +
             random_stalls(11, 300)},
        {"four ports, two banks, narrow", small,
         "timing.summed_height_table_ports=4 timing.summed_height_table_banks=2 "
         "timing.summed_height_table_width=3"},
        {"a cylinder in repeat, three tests units, stalls", cylinder, "hardware.tests_units=3 " + random_stalls(5, 400),
         3000},
        {"random stalls of half of all items", small, random_stalls(3, 500)},
        {"every item of every channel stalled", small, "hardware.tests_units=3 " + random_stalls(4, 1000, 5)},

        {"one place for an incomplete triangle, stalls", small,
         "timing.pass_or_tessellate_buffer=1 timing.results_buffer=1 " + random_stalls(8, 400)},
        {"large buffers everywhere", small,
         every_unit("buffer", 37) + every_table("buffer", 37) +
             "timing.results_buffer=37 hardware.queue_watermark=1000 " + random_stalls(9, 200)},
        {"intervals and latencies of all sizes", small,
         every_unit("latency", [](int k) { return 1 + (k + 1) * 7 % 13; }) +
             every_unit("interval", [](int k) { return 1 + (k + 1) * 5 % 11; }) + "hardware.transform_pipelines=3"},

        {"a queue large enough never overflows", small, bounded_queue("lifo", 64) + "hardware.queue_overflow=error"},
        {"the watermark admits host triangles while fewer wait", small, "hardware.queue_watermark=40"},
    },
    [](const TimedMesh& row) {
        const CheckedRun run(with_settings(timed_job(), row.job + row.settings));
        CHECK(run.conformance.passed(0.5));
        CHECK(run.mesh.triangles.size() > 2 * run.setup.base_triangles.size());
        CHECK(run.machine.edges_tested() > row.more_edges_than);
    });

struct Spill {
    std::string name;
    std::string settings;
    std::size_t places;
};

const CaseTable spills(
    "timed mesh: ",
    {
        Spill{"first in first out, one place, spills", bounded_queue("fifo", 1), 1},
        {"first in first out, 64 places, spills to a slow memory",
         bounded_queue("fifo", 64) + "timing.off_chip_latency=500 timing.off_chip_bandwidth=3 timing.off_chip_buffer=1",
         64},
        {"last in first out, 8 places, spills and stalls", bounded_queue("lifo", 8) + random_stalls(22, 300), 8},
        {"last in first out, 8 places, many host triangles, a fast memory",
         bounded_queue("lifo", 8) +
             "hardware.queue_watermark=200 timing.off_chip_latency=0 timing.off_chip_bandwidth=4096 "
             "timing.off_chip_buffer=1",
         8},
    },
    [](const Spill& row) {
        const CheckedRun run(with_settings(timed_job(), small + row.settings));
        const TriangleQueue& its_queue = run.machine.triangle_queue;
        CHECK(its_queue.spilled() > 0);
        CHECK(its_queue.on_chip_high_water_mark() == row.places + 1);  // and one on its way out
        CHECK(its_queue.high_water_mark() > row.places + 1);
        CHECK(run.machine.off_chip_memory.bytes_written() % its_queue.spilled() == 0);
    });

}  // namespace

TEST_CASE("timed mesh: a cylinder in repeat, whose rectangles wrap") {
    const CheckedRun run(with_settings(timed_job(), cylinder));
    // up to nine entries for one that wraps
    CHECK(run.machine.height_table.transactions() > 12 * run.machine.edges_tested());
    CHECK(run.machine.edges_tested() > 3000);
}

TEST_CASE("timed mesh: culling") {
    const CheckedRun run(
        with_settings(timed_job(), small + "hardware.culling=back camera.eye=[0,-4,0.6] " + random_stalls(6, 100)));
    CHECK(run.counts.culled > 0);
    CHECK(run.simulation.rasteriser.triangles() > 0);
}

// Each split adds three triangles to the queue, net, along one path of at most 12 generations; some more passes, and
// their children, are in flight.
TEST_CASE("timed mesh: last in first out, 64 places: nothing is spilled") {
    const CheckedRun run(with_settings(timed_job(), small + bounded_queue("lifo", 64)));
    CHECK(run.machine.triangle_queue.spilled() == 0);
    CHECK(run.machine.triangle_queue.high_water_mark() <= 64);
    CHECK(run.machine.off_chip_memory.occupied_cycles() == 0);
}

// The same counts as without stalls; only the time differs.
TEST_CASE("timed mesh: stalls change the number of cycles and nothing else") {
    const CheckedRun run(with_settings(timed_job(), small + random_stalls(31, 300)));
    CHECK(run.machine.height_table.transactions() == 12 * run.machine.edges_tested());
    CHECK(run.simulation.cycles() > 36 * run.counts.passes + 17);
}
