#include <catch2/catch.hpp>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/common/error.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/tests/support/timed_checks.h"

// Designs at the ends of what a job may ask for: each emits the bare datapath's mesh, decided as the golden model
// decides, closed, with every item accounted for.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// A few hundred triangles, of every size.
Job small_job() {
    Job job = timed_job();
    job.map.width = job.map.height = 32;
    job.tests.summed_height_threshold = 0.3;
    job.tests.generation_limit = 5;
    return job;
}

/// Runs in timed mode; everything that must hold of any run. Gives its cycles.
std::uint64_t expect_whole_run(const Job& job, bool splits = true) {
    const MachineSetup setup = setup_of(job);
    const GoldenInputs golden(setup);
    Scoreboard scoreboard(setup.registers, golden);
    Simulation simulation(setup, 1'000'000, 100'000'000);
    simulation.pipeline.pass_or_tessellate.decided.bind(scoreboard);
    run_timed(simulation);
    const ConformanceResult result = scoreboard.result();
    INFO(result.first_mismatch);
    CHECK(result.mismatches == 0);
    const InvariantResult invariants = check_invariants(simulation.monitor.mesh, setup);
    INFO(invariants.first_violation);
    CHECK(invariants.passed());
    BareRecursion bare(setup);
    EmittedMesh mesh;
    CHECK(bare.run(mesh) == simulation.pipeline.edges_tested());
    CHECK(keys(mesh) == keys(simulation.monitor.mesh));
    CHECK((mesh.triangles.size() > setup.base_triangles.size()) == splits);
    return simulation.cycles();
}

void stall(Job& job, std::uint64_t seed, unsigned per_mille, unsigned longest) {
    job.timing.stalls = {seed, per_mille, longest};
}

void all_memories(Job& job, unsigned latency) {
    job.timing.displacement_map.latency = job.timing.normal_map.latency =
        job.timing.summed_height_table.latency = latency;
    job.timing.off_chip_memory.latency = latency;
}

void queue_of(Job& job, std::int64_t capacity, QueueOrder order) {
    job.hardware.queue_capacity = capacity;
    job.hardware.queue_order = order;
}

template <class Change>
void all_units(Job& job, Change change) {
    Timing& t = job.timing;
    for (UnitTiming* const unit :
         {&t.get_triangle, &t.calculate_new_p, &t.displace_vertex, &t.transform, &t.calculate_new_u,
          &t.tex_coord_test, &t.summed_height_test, &t.normal_test, &t.view_test, &t.pass_or_tessellate,
          &t.tessellation, &t.triangle_queue, &t.lighting})
        change(*unit);
}

}  // namespace

TEST_CASE("limits: one place in the queue, all channels stalling, memories of latency 0") {
    Job job = small_job();
    queue_of(job, 1, QueueOrder::fifo);
    stall(job, 101, 400, 20);
    all_memories(job, 0);
    expect_whole_run(job);
}
TEST_CASE("limits: one place in the queue, newest first, all channels stalling, memories of latency 1000") {
    Job job = small_job();
    queue_of(job, 1, QueueOrder::lifo);
    stall(job, 102, 300, 20);
    all_memories(job, 1000);
    expect_whole_run(job);
}
TEST_CASE("limits: two places in the queue, all channels always stalling, memories of latency 1") {
    Job job = small_job();
    queue_of(job, 2, QueueOrder::fifo);
    stall(job, 103, 1000, 50);
    all_memories(job, 1);
    expect_whole_run(job);
}
TEST_CASE(
    "limits: two places in the queue, newest first, three tests units, stalls, one place in every buffer") {
    Job job = small_job();
    queue_of(job, 2, QueueOrder::lifo);
    stall(job, 104, 500, 9);
    job.hardware.tests_units = 3;
    job.hardware.transform_pipelines = 16;
    all_units(job, [](UnitTiming& unit) { unit.buffer = 1; });
    job.timing.results_buffer = 1;
    job.timing.off_chip_memory.buffer = 1;
    expect_whole_run(job);
}
TEST_CASE("limits: the Summed Height Table 1000 cycles away, the others at hand") {
    Job job = small_job();
    all_memories(job, 0);
    job.timing.summed_height_table.latency = 1000;
    // one edge after another, none waits for another's reads: at least its own, at most as if nothing overlapped
    const std::uint64_t cycles = expect_whole_run(job);
    CHECK(cycles > 1000);
}
TEST_CASE("limits: the displacement map 1000 cycles away, the others at hand") {
    Job job = small_job();
    all_memories(job, 0);
    job.timing.displacement_map.latency = 1000;
    CHECK(expect_whole_run(job) > 1000);
}
TEST_CASE("limits: the normal map 1000 cycles away, the others at hand") {
    Job job = small_job();
    all_memories(job, 0);
    job.timing.normal_map.latency = 1000;
    CHECK(expect_whole_run(job) > 1000);
}
TEST_CASE("limits: off-chip memory 1000 cycles away, a byte a cycle, one request at a time") {
    Job job = small_job();
    queue_of(job, 1, QueueOrder::fifo);
    job.timing.off_chip_memory.latency = 1000;
    job.timing.off_chip_memory.bandwidth = 1;
    job.timing.off_chip_memory.buffer = 1;
    expect_whole_run(job);
}
TEST_CASE("limits: every latency and interval 1") {
    Job job = small_job();
    all_units(job, [](UnitTiming& unit) { unit = {1, 1, 1}; });
    all_memories(job, 0);
    job.timing.summed_height_table.ports = 64;
    job.timing.summed_height_table.banks = 64;
    expect_whole_run(job);
}
TEST_CASE("limits: every latency and interval 1000, stalls") {
    Job job = small_job();
    job.tests.generation_limit = 2;
    all_units(job, [](UnitTiming& unit) { unit = {1000, 1000, 1}; });
    stall(job, 105, 200, 1000);
    // Transform, if none else: one part after another, 1000 cycles each
    CHECK(expect_whole_run(job) > 100'000);
}
TEST_CASE("limits: narrow memories, one byte a cycle") {
    Job job = small_job();
    job.timing.summed_height_table.width = job.timing.normal_map.width = job.timing.displacement_map.width =
        1;
    expect_whole_run(job);
}

TEST_CASE("limits: nothing to split, one triangle, one place in the queue, stalls") {
    Job job = small_job();
    job.map.source = MapSource::constant;
    queue_of(job, 1, QueueOrder::fifo);
    stall(job, 106, 1000, 100);
    expect_whole_run(job, false);
}
TEST_CASE("limits: no test asks for a split") {
    Job job = small_job();
    job.tests.normal = job.tests.summed_height = false;
    expect_whole_run(job, false);
}
TEST_CASE("limits: a generation limit of 0") {
    Job job = small_job();
    job.tests.generation_limit = 0;
    expect_whole_run(job, false);
}
TEST_CASE("limits: a map of one texel") {
    Job job = small_job();
    job.map.width = job.map.height = 1;
    expect_whole_run(job, false);
}
TEST_CASE("limits: a map of one texel, repeated") {
    Job job = small_job();
    job.map.source = MapSource::noise;
    job.map.width = job.map.height = 1;
    job.map.address_u = job.map.address_v = Addressing::repeat;
    expect_whole_run(job, false);
}
TEST_CASE("limits: a map of one row") {
    Job job = small_job();
    job.map.source = MapSource::noise;
    job.map.width = 64;
    job.map.height = 1;
    expect_whole_run(job);
}
TEST_CASE("limits: a map of one column") {
    Job job = small_job();
    job.map.source = MapSource::noise;
    job.map.width = 1;
    job.map.height = 64;
    expect_whole_run(job);
}
TEST_CASE("limits: a viewport of one pixel splits nothing that the View Test measures in pixels") {
    Job job = small_job();
    job.camera.viewport_width = job.camera.viewport_height = 1;
    expect_whole_run(job, false);
}
TEST_CASE("limits: an eye within the heights, on whose near plane edges end") {
    Job job = small_job();
    job.camera.eye = {0.01, 0.02, 0.1};
    job.camera.target = {1, 0, 0.1};
    expect_whole_run(job);
}
TEST_CASE("limits: all of it behind the camera: no edge is seen, none splits") {
    Job job = small_job();
    job.camera.eye = {0, -3, 0.5};
    job.camera.target = {0, -6, 0.5};
    expect_whole_run(job, false);
}
TEST_CASE("limits: all of it beyond the near plane's reach: likewise") {
    Job job = small_job();
    job.camera.near_plane = 1e6;
    expect_whole_run(job, false);
}
TEST_CASE("limits: all of it seen from behind and culled: nothing is lit, the mesh is whole") {
    Job job = small_job();
    job.map.source = MapSource::constant;
    job.camera.eye = {0, -3.2, -2.4};
    job.hardware.culling = Culling::back;
    expect_whole_run(job, false);
}
TEST_CASE("limits: a clock whose period and latencies are the longest, in timed and in functional mode") {
    Job job = small_job();
    job.tests.generation_limit = 1;
    job.timing.cycle_picoseconds = 1'000'000'000;
    all_units(job, [](UnitTiming& unit) { unit = {1'000'000, 1'000'000, 1}; });
    expect_whole_run(job);
}
