#include <cstdint>
#include <string>

#include "testbench/tests/support/case_table.h"
#include "testbench/tests/support/checked_run.h"
#include "testbench/tests/support/job_settings.h"

// Designs at the limits of a job's keys: each emits the bare datapath's mesh, closed, with the golden model's decisions
// and no item lost.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// A few hundred triangles of all sizes.
const std::string small = "map.width=32 map.height=32 tests.summed_height_threshold=0.3 tests.generation_limit=5 ";

std::string all_memories(int latency) {
    return every_table("latency", latency) + "timing.off_chip_latency=" + std::to_string(latency) + " ";
}

std::string all_units(int latency, int interval, int buffer) {
    return every_unit("latency", latency) + every_unit("interval", interval) + every_unit("buffer", buffer);
}

struct Row {
    std::string name;
    std::string settings;
    std::uint64_t more_cycles_than = 0;
};

void expect_whole_run(const Row& row, bool splits) {
    const CheckedRun run(with_settings(timed_job(), small + row.settings));
    CHECK((run.counts.edges_split > 0) == splits);
    CHECK(run.simulation.cycles() > row.more_cycles_than);
}

const CaseTable designs(
    "limits: ",
    {
        Row{"one place in the queue, all channels stalling, memories of latency 0",
            bounded_queue("fifo", 1) + random_stalls(101, 400, 20) + all_memories(0)},
        {"one place in the queue, newest first, all channels stalling, memories of latency 1000",
         bounded_queue("lifo", 1) + random_stalls(102, 300, 20) + all_memories(1000)},
        {"two places in the queue, all channels always stalling, memories of latency 1",
         bounded_queue("fifo", 2) + random_stalls(103, 1000, 50) + all_memories(1)},
        {"two places in the queue, newest first, three tests units, stalls, one place in every buffer",
         bounded_queue("lifo", 2) + random_stalls(104, 500, 9) + every_unit("buffer", 1) +
             "hardware.tests_units=3 hardware.transform_pipelines=16 timing.results_buffer=1 "
             "timing.off_chip_buffer=1"},
        // edges do not wait for one another's reads: at least one edge's own
        {"a Summed Height Table of latency 1000, other memories of latency 0",
         all_memories(0) + "timing.summed_height_table_latency=1000", 1000},
        {"a displacement map of latency 1000, other memories of latency 0",
         all_memories(0) + "timing.displacement_map_latency=1000", 1000},
        {"a normal map of latency 1000, other memories of latency 0",
         all_memories(0) + "timing.normal_map_latency=1000", 1000},
        {"off-chip memory of latency 1000, one byte per cycle, one request at a time",
         bounded_queue("fifo", 1) +
             "timing.off_chip_latency=1000 timing.off_chip_bandwidth=1 timing.off_chip_buffer=1"},
        {"every latency and interval 1", all_units(1, 1, 1) + all_memories(0) +
                                             "timing.summed_height_table_ports=64 timing.summed_height_table_banks=64"},
        // at least Transform: one part after another, 1000 cycles each
        {"every latency and interval 1000, stalls",
         "tests.generation_limit=2 " + all_units(1000, 1000, 1) + random_stalls(105, 200, 1000), 100'000},
        {"narrow memories, one byte per cycle", every_table("width", 1)},
        {"the longest clock period and latencies",
         "tests.generation_limit=1 timing.clock_period=1000000000 " + all_units(1'000'000, 1'000'000, 1)},
        {"a map of one row", "map.source=noise map.width=64 map.height=1"},
        {"a map of one column", "map.source=noise map.width=1 map.height=64"},
        {"an eye within the heights, with edges that end on the near plane",
         "camera.eye=[0.01,0.02,0.1] camera.target=[1,0,0.1]"},
        {"an eye in the base plane", "camera.eye=[0,0,0] camera.target=[0,1,0]"},
        {"an eye below the surface", "camera.eye=[0,-3.2,-2.4]"},
        {"a viewport of one column", "camera.viewport_width=1 camera.viewport_height=16384 camera.eye=[1,-3,2.5]"},
        {"a field of view of 0.1 degrees", "camera.field_of_view=0.1 camera.eye=[1,-3,2.5]"},
        {"a dot on the screen", "camera.eye=[0,-150,120]"},
        {"heights below the base mesh", "displacement.scale=-0.25"},
        {"heights of 0", "displacement.scale=0"},
        {"thresholds of 0", "tests.normal_threshold=0 tests.summed_height_threshold=0 tests.view_threshold=0"},
    },
    [](const Row& row) { expect_whole_run(row, true); });

const CaseTable whole(
    "limits: ",
    {
        Row{"nothing to split, one place in the queue, stalls",
            "map.source=constant " + bounded_queue("fifo", 1) + random_stalls(106, 1000, 100)},
        {"no test requests a split", "tests.normal=false tests.summed_height=false"},
        {"heights of 0, and no test of the map alone", "displacement.scale=0 tests.summed_height=false"},
        {"a generation limit of 0", "tests.generation_limit=0"},
        {"a map of one texel", "map.width=1 map.height=1"},
        {"a map of one texel, repeated",
         "map.source=noise map.width=1 map.height=1 map.address_u=repeat map.address_v=repeat"},
        {"a viewport of one pixel, in which the View Test allows no split",
         "camera.viewport_width=1 camera.viewport_height=1"},
        {"a mesh behind the camera, which splits no edge", "camera.eye=[0,-3,0.5] camera.target=[0,-6,0.5]"},
        {"a mesh nearer than the near plane, which splits no edge", "camera.near_plane=1e6"},
    },
    [](const Row& row) { expect_whole_run(row, false); });

}  // namespace

TEST_CASE("limits: a mesh seen from behind is culled: nothing is lit, the mesh is complete") {
    const CheckedRun run(
        with_settings(timed_job(), "map.source=constant camera.eye=[0,-3.2,-2.4] hardware.culling=back"));
    CHECK(run.counts.edges_split == 0);
    CHECK(run.counts.culled == run.setup.base_triangles.size());
    CHECK(run.simulation.rasteriser.triangles() == 0);
}
