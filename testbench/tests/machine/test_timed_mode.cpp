#include <catch2/catch.hpp>
#include <set>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/tests/support/timed_checks.h"

// Two modes, one mesh: whatever the timing, the stalls, the buffers and the queue's order, timed mode emits the bare
// datapath's triangles, bit for bit.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// A timed run against the bare recursion on the same setup.
void expect_bare_mesh(const MachineSetup& setup) {
    Simulation simulation(setup, 1'000'000, 100'000);
    run_timed(simulation);
    BareRecursion bare(setup);
    EmittedMesh mesh;
    CHECK(bare.run(mesh) == simulation.pipeline.edges_tested());
    CHECK(mesh.triangles.size() > 2 * setup.base_triangles.size());
    CHECK((keys(mesh) == keys(simulation.monitor.mesh)));  // not to be printed
}

void expect_bare_mesh(const Job& job) {
    expect_bare_mesh(setup_of(job));
}

/// About a thousand triangles of every size, and base triangles that do not split.
Job small_job() {
    Job job = timed_job();
    job.map.width = job.map.height = 64;
    job.tests.summed_height_threshold = 0.2;
    return job;
}

Job cylinder_job() {
    Job job = timed_job();
    job.mesh.source = MeshSource::cylinder;
    job.mesh.columns = 8;
    job.mesh.rows = 4;
    job.map.source = MapSource::noise;
    job.map.width = 64;
    job.map.height = 33;
    job.map.address_u = Addressing::repeat;
    job.displacement.scale = 0.1;
    job.tests.view_threshold = 24;
    return job;
}

void stall(Job& job, std::uint64_t seed, unsigned per_mille, unsigned longest = 16) {
    job.timing.stalls = {seed, per_mille, longest};
}

void set_queue(Job& job, QueueOrder order, std::int64_t capacity, Overflow overflow = Overflow::spill) {
    job.hardware.queue_order = order;
    job.hardware.queue_capacity = capacity;
    job.hardware.queue_overflow = overflow;
}

void expect_spilled(const Job& job, std::size_t highest) {
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 100'000);
    run_timed(simulation);
    BareRecursion bare(setup);
    EmittedMesh mesh;
    bare.run(mesh);
    CHECK((keys(mesh) == keys(simulation.monitor.mesh)));  // not to be printed
    const TriangleQueue& queue = simulation.pipeline.triangle_queue;
    CHECK(queue.spilled() > 0);
    CHECK(queue.on_chip_high_water_mark() == highest);
    CHECK(queue.high_water_mark() > highest);
    CHECK(simulation.pipeline.off_chip_memory.bytes_written() % queue.spilled() == 0);
}

}  // namespace

TEST_CASE("timed mesh: half donut, the paper's design") {
    expect_bare_mesh(timed_job());
}

TEST_CASE("timed mesh: half donut through the scoreboard, every decision as the golden model's") {
    Job job = timed_job();
    job.hardware.tests_units = 3;
    job.timing.summed_height_table.ports = 4;
    stall(job, 3, 200);
    const MachineSetup setup = setup_of(job);
    const GoldenInputs golden(setup);
    Simulation simulation(setup, 1'000'000);
    Scoreboard scoreboard(setup.registers, golden);
    simulation.pipeline.pass_or_tessellate.decided.bind(scoreboard);
    run_timed(simulation);
    const ConformanceResult result = scoreboard.result();
    INFO(result.first_mismatch);
    CHECK(result.mismatches == 0);
    CHECK(result.passed(0.5));
    CHECK(result.edges == simulation.pipeline.edges_tested());
    CHECK(result.edges > 50'000);
}

TEST_CASE("timed mesh: every item through its packed form, three tests units, a Highlight Test") {
    Job job = small_job();
    job.hardware.tests_units = 3;
    job.tests.highlight = true;
    MachineSetup setup = setup_of(job);
    setup.design.packed_streams = true;
    expect_bare_mesh(setup);
}

TEST_CASE("timed mesh: last in first out") {
    Job job = small_job();
    job.hardware.queue_order = QueueOrder::lifo;
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: three tests units") {
    Job job = small_job();
    job.hardware.tests_units = 3;
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: three tests units, four ports, last in first out, stalls") {
    Job job = small_job();
    job.hardware.tests_units = 3;
    job.hardware.queue_order = QueueOrder::lifo;
    job.timing.summed_height_table.ports = 4;
    stall(job, 11, 300);
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: two ports") {
    Job job = small_job();
    job.timing.summed_height_table.ports = 2;
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: four ports, two banks, narrow") {
    Job job = small_job();
    job.timing.summed_height_table.ports = 4;
    job.timing.summed_height_table.banks = 2;
    job.timing.summed_height_table.width = 3;
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: a cylinder in repeat, whose rectangles wrap") {
    Job job = cylinder_job();
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 100'000);
    run_timed(simulation);
    BareRecursion bare(setup);
    EmittedMesh mesh;
    bare.run(mesh);
    CHECK((keys(mesh) == keys(simulation.monitor.mesh)));  // not to be printed
    // up to nine entries where one wraps
    CHECK(simulation.pipeline.summed_height_table.transactions() > 12 * simulation.pipeline.edges_tested());
    CHECK(simulation.pipeline.edges_tested() > 3000);
}

TEST_CASE("timed mesh: a cylinder in repeat, three tests units, stalls") {
    Job job = cylinder_job();
    job.hardware.tests_units = 3;
    stall(job, 5, 400);
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: culling") {
    Job job = small_job();
    job.hardware.culling = Culling::back;
    job.camera.eye = {0, -4, 0.6};
    stall(job, 6, 100);
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 100'000);
    run_timed(simulation);
    CHECK(simulation.pipeline.pass_or_tessellate.counts().culled > 0);
    CHECK(simulation.rasteriser.triangles() > 0);
    BareRecursion bare(setup);
    EmittedMesh mesh;
    bare.run(mesh);
    const auto without_culled = [](EmittedMesh its_mesh) {  // the bare recursion does not cull
        for (EmittedTriangle& triangle : its_mesh.triangles)
            triangle.culled = false;
        return keys(its_mesh);
    };
    CHECK(without_culled(mesh) == without_culled(simulation.monitor.mesh));
}

TEST_CASE("timed mesh: random stalls, seed 1, 100 per mille") {
    Job job = small_job();
    stall(job, 1, 100);
    expect_bare_mesh(job);
}
TEST_CASE("timed mesh: random stalls, seed 2, 300 per mille, up to 40 cycles") {
    Job job = small_job();
    stall(job, 2, 300, 40);
    expect_bare_mesh(job);
}
TEST_CASE("timed mesh: random stalls, seed 3, 500 per mille, last in first out") {
    Job job = small_job();
    stall(job, 3, 500);
    job.hardware.queue_order = QueueOrder::lifo;
    expect_bare_mesh(job);
}
TEST_CASE("timed mesh: every item of every channel stalled") {
    Job job = small_job();
    stall(job, 4, 1000, 5);
    job.hardware.tests_units = 3;
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: one place for an incomplete triangle") {
    Job job = small_job();
    job.timing.pass_or_tessellate.buffer = 1;
    job.timing.results_buffer = 1;
    expect_bare_mesh(job);
}
TEST_CASE("timed mesh: one place for an incomplete triangle, three tests units, stalls") {
    Job job = small_job();
    job.timing.pass_or_tessellate.buffer = 1;
    job.timing.results_buffer = 1;
    job.hardware.tests_units = 3;
    stall(job, 8, 400);
    expect_bare_mesh(job);
}
TEST_CASE("timed mesh: large buffers everywhere") {
    Job job = small_job();
    Timing& t = job.timing;
    for (UnitTiming* unit :
         {&t.get_triangle, &t.calculate_new_p, &t.displace_vertex, &t.transform, &t.calculate_new_u,
          &t.tex_coord_test, &t.summed_height_test, &t.normal_test, &t.view_test, &t.pass_or_tessellate,
          &t.tessellation, &t.triangle_queue, &t.lighting})
        unit->buffer = 37;
    t.results_buffer = 37;
    t.summed_height_table.buffer = t.displacement_map.buffer = t.normal_map.buffer = 37;
    job.hardware.queue_watermark = 1000;
    stall(job, 9, 200);
    expect_bare_mesh(job);
}
TEST_CASE("timed mesh: intervals and latencies of all sizes") {
    Job job = small_job();
    Timing& t = job.timing;
    unsigned number = 1;
    for (UnitTiming* unit :
         {&t.get_triangle, &t.calculate_new_p, &t.displace_vertex, &t.transform, &t.calculate_new_u,
          &t.tex_coord_test, &t.summed_height_test, &t.normal_test, &t.view_test, &t.pass_or_tessellate,
          &t.tessellation, &t.triangle_queue, &t.lighting}) {
        unit->latency = 1 + number * 7 % 13;
        unit->interval = 1 + number * 5 % 11;
        ++number;
    }
    job.hardware.transform_pipelines = 3;
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: memories of latency 0") {
    Job job = small_job();
    job.timing.summed_height_table.latency = job.timing.displacement_map.latency =
        job.timing.normal_map.latency = 0;
    expect_bare_mesh(job);
}
TEST_CASE("timed mesh: memories of latency 300, 100 and 30") {
    Job job = small_job();
    job.timing.summed_height_table.latency = 300;
    job.timing.displacement_map.latency = 100;
    job.timing.normal_map.latency = 30;
    job.hardware.tests_units = 3;
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: tests switched off") {
    Job job = small_job();
    job.tests.summed_height = false;
    job.tests.view = false;
    stall(job, 12, 200);
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: first in first out, one place, spills") {
    Job job = small_job();
    set_queue(job, QueueOrder::fifo, 1);
    expect_spilled(job, 1);
}
TEST_CASE("timed mesh: first in first out, 8 places, spills and stalls") {
    Job job = small_job();
    set_queue(job, QueueOrder::fifo, 8);
    stall(job, 21, 300);
    expect_spilled(job, 8);
}
TEST_CASE("timed mesh: first in first out, 64 places, spills to a slow memory") {
    Job job = small_job();
    set_queue(job, QueueOrder::fifo, 64);
    job.timing.off_chip_memory = {500, 3, 1};
    expect_spilled(job, 64);
}
TEST_CASE("timed mesh: last in first out, one place, spills") {
    Job job = small_job();
    set_queue(job, QueueOrder::lifo, 1);
    expect_spilled(job, 1);
}
TEST_CASE("timed mesh: last in first out, 8 places, spills and stalls") {
    Job job = small_job();
    set_queue(job, QueueOrder::lifo, 8);
    stall(job, 22, 300);
    expect_spilled(job, 8);
}
TEST_CASE("timed mesh: last in first out, 8 places, many host triangles, a fast memory") {
    Job job = small_job();
    set_queue(job, QueueOrder::lifo, 8);
    job.hardware.queue_watermark = 200;
    job.timing.off_chip_memory = {0, 4096, 1};
    expect_spilled(job, 8);
}
TEST_CASE("timed mesh: last in first out, 64 places are enough: nothing is spilled") {
    // each split puts back three more triangles than it takes, along one path of at most 12 generations; with some
    // passes under way besides, and their children
    Job job = small_job();
    set_queue(job, QueueOrder::lifo, 64);
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 100'000);
    run_timed(simulation);
    CHECK(simulation.pipeline.triangle_queue.spilled() == 0);
    CHECK(simulation.pipeline.triangle_queue.high_water_mark() <= 64);
    CHECK(simulation.pipeline.off_chip_memory.occupied_cycles() == 0);
}
TEST_CASE("timed mesh: a queue large enough never overflows, whatever happens beyond it") {
    Job job = small_job();
    set_queue(job, QueueOrder::lifo, 64, Overflow::error);
    expect_bare_mesh(job);
}

TEST_CASE("timed mesh: the watermark lets host triangles in while fewer wait") {
    Job job = small_job();
    job.hardware.queue_watermark = 40;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 100'000);
    run_timed(simulation);
    BareRecursion bare(setup);
    EmittedMesh mesh;
    bare.run(mesh);
    CHECK((keys(mesh) == keys(simulation.monitor.mesh)));  // not to be printed
}

TEST_CASE("timed mesh: stalls cost cycles and nothing else") {
    // the same counts as without; only time differs
    Job job = small_job();
    stall(job, 31, 300);
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 100'000);
    run_timed(simulation);
    const Pipeline& p = simulation.pipeline;
    CHECK(p.summed_height_table.transactions() == 12 * p.edges_tested());
    CHECK(simulation.cycles() > 36 * p.pass_or_tessellate.counts().passes + 17);
}
