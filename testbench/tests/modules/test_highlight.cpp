#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/benchmark/gouraud_error.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/tests/support/timed_checks.h"

// The whole machine with a Highlight Test: its meshes, its cycles, and what it is for.

using namespace tessera;
using namespace tessera::testing;

namespace {

Job with_highlight(Job job) {
    job.tests.highlight = true;
    return job;
}

Job functional_job() {
    Job job;
    job.mode = Mode::functional;
    return job;
}

Job noisy_sphere_job() {
    Job job = functional_job();
    job.mesh.source = MeshSource::sphere;
    job.mesh.columns = 24;
    job.mesh.rows = 12;
    job.map.source = MapSource::noise;
    job.map.address_u = Addressing::repeat;
    job.displacement.scale = 0.02;
    job.formats.normal_bits = 12;
    job.formats.normal_fraction = 10;
    return job;
}

EmittedMesh bare_mesh(const MachineSetup& setup) {
    BareRecursion bare(setup);
    EmittedMesh mesh;
    bare.run(mesh);
    return mesh;
}

/// The bare recursion's mesh, no edge that the golden model does not explain, and some edges split by HT alone.
void expect_conforming_mesh(const Job& job) {
    const MachineSetup setup = setup_of(job);
    const GoldenInputs golden(setup);
    Simulation simulation(setup, 1'000'000, 100'000);
    Scoreboard scoreboard(setup.registers, golden);
    simulation.pipeline.pass_or_tessellate.decided.bind(scoreboard);
    if (job.mode == Mode::timed)
        run_timed(simulation);
    else
        REQUIRE(simulation.run().empty());
    CHECK((keys(bare_mesh(setup)) == keys(simulation.monitor.mesh)));  // not to be printed

    const ConformanceResult result = scoreboard.result();
    INFO(result.first_mismatch);
    CHECK(result.mismatches == 0);
    CHECK(result.passed(0.5));
    CHECK(result.edges == simulation.pipeline.edges_tested());
    const InvariantResult invariants = check_invariants(simulation.monitor.mesh, setup);
    INFO(invariants.first_violation);
    CHECK(invariants.passed());
    const auto& counts = simulation.pipeline.pass_or_tessellate.counts();
    CHECK(counts.split_by_highlight > 100);
    CHECK(counts.split_by_highlight <= counts.split_in_highlight);
    CHECK(counts.split_by_normal + counts.split_by_summed_height + counts.split_by_both +
              counts.split_by_highlight ==
          counts.edges_split);
}

std::uint64_t cycles_of(const MachineSetup& setup) {
    Simulation simulation(setup, 1'000'000, 100'000);
    run_timed(simulation);
    return simulation.cycles();
}

MachineSetup one_triangle(unsigned highlight_test_latency) {
    Job job = with_highlight(timed_job());
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::constant;
    job.timing.highlight_test_latency = highlight_test_latency;
    MachineSetup setup = setup_of(job);
    setup.base_triangles.resize(1);
    return setup;
}

}  // namespace

TEST_CASE("Highlight Test: half donut, functional, conforms") {
    expect_conforming_mesh(with_highlight(functional_job()));
}
TEST_CASE("Highlight Test: noisy sphere, narrow normals, functional, conforms") {
    Job job = noisy_sphere_job();
    job.tests.summed_height_threshold = 2;  // leaves edges to the Highlight Test
    job.tests.view_threshold = 2;
    expect_conforming_mesh(with_highlight(job));
}
TEST_CASE("Highlight Test: half donut, timed, conforms") {
    expect_conforming_mesh(with_highlight(timed_job()));
}
TEST_CASE("Highlight Test: three tests units, stalls, and a queue that spills its bit, timed, conforms") {
    Job job = with_highlight(timed_job());
    job.hardware.tests_units = 3;
    job.hardware.queue_capacity = 20;
    job.timing.summed_height_table.ports = 4;
    job.timing.stalls = {5, 300, 16};
    expect_conforming_mesh(job);
}

// test_timed_pipeline.cpp: edge 2 starts in the Normal Test in 32, is read in 33, and is through 9 + 1 later, in 43,
// before the Summed Height Test's 47.
TEST_CASE("Highlight Test: one triangle takes 86 cycles, as without") {
    CHECK(cycles_of(one_triangle(1)) == 86);
}
// Two ports: the Summed Height Test is through in 41, the Normal Test in 43: 43 + 38, and the cycle numbered 0.
TEST_CASE("Highlight Test: one triangle, two ports: one cycle more than the 81 without") {
    MachineSetup setup = one_triangle(1);
    setup.design.timing.summed_height_table.ports = 2;
    CHECK(cycles_of(setup) == 43 + 38 + 1);
}
// 33 + 9 + 300 = 342.
TEST_CASE("Highlight Test: one triangle, 300 cycles for it") {
    CHECK(cycles_of(one_triangle(300)) == 342 + 38 + 1);
}

// 18 base triangles, each split into four until generation 4 (test_timed_throughput.cpp): the Summed Height Table's 36
// cycles a pass bound it, and the Highlight Test asks for what is split anyway.
TEST_CASE("Highlight Test: the paper's design is as fast with it") {
    Job job = with_highlight(full_split_job(3, 4));
    job.tests.highlight_normal_threshold = 0;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    run_timed(simulation);
    CHECK(simulation.pipeline.pass_or_tessellate.counts().passes == 6138);
    CHECK(simulation.pipeline.pass_or_tessellate.counts().split_in_highlight > 50);
    CHECK(simulation.cycles() == 5 + 3 + 36 * 6138 + 9);
}

TEST_CASE("Highlight Test: registers follow from the light and the camera") {
    Job job = with_highlight(functional_job());
    job.hardware.light = {0, 0, 5};
    job.camera.eye = {0, -3, 0};
    job.camera.target = {0, 0, 0};
    job.tests.highlight_angle = 60;
    job.tests.highlight_normal_threshold = 0.25;
    const MachineSetup setup = setup_of(job);
    const datapath::TestParameters& tests = setup.registers.tests;
    CHECK(tests.highlight_test);
    CHECK(setup.registers.formats.highlight_tag);
    const std::int32_t half = 11585;  // sqrt(1/2) * 2^14
    CHECK(tests.half_vector == std::array<std::int32_t, 3>{0, -half, half});
    CHECK(tests.highlight_cosine == 1 << 27);
    CHECK(tests.highlight_normal_threshold == 1 << 12);
    CHECK(setup.remarks.empty());

    job.camera.eye = {0, 0, -3};  // against the light
    job.camera.up = {0, 1, 0};
    const MachineSetup against = setup_of(job);
    CHECK(against.registers.tests.half_vector == std::array<std::int32_t, 3>{});
    REQUIRE(against.remarks.size() == 1);
    CHECK(against.remarks.front().find("hardware.light") != std::string::npos);

    job.tests.highlight = false;
    const MachineSetup off = setup_of(job);
    CHECK_FALSE(off.registers.tests.highlight_test);
    CHECK_FALSE(off.registers.formats.highlight_tag);
    CHECK(off.registers.tests.half_vector == std::array<std::int32_t, 3>{});
}

TEST_CASE("Highlight Test: splits in the highlight, and there only") {
    const MachineSetup with = setup_of(with_highlight(functional_job()));
    const auto cosine = [&](const datapath::Direction& n) {
        const auto& h = with.registers.tests.half_vector;
        return std::int64_t{n.x} * h[0] + std::int64_t{n.y} * h[1] + std::int64_t{n.z} * h[2];
    };
    std::uint64_t alone = 0;
    for (const EmittedTriangle& triangle : bare_mesh(with).triangles) {
        if (triangle.split_by != datapath::highlight_bit)
            continue;
        ++alone;
        // A corner is an inserted vertex, its edge left whole by NT: its normal's components are within 0.12 of the
        // lit one's, an angle of at most 12 degrees.
        std::int64_t nearest = cosine(triangle.corners[0].displaced_normal);
        for (const auto& corner : triangle.corners)
            nearest = std::max(nearest, cosine(corner.displaced_normal));
        CHECK(static_cast<double>(nearest) > std::ldexp(std::cos((25 + 12) * 3.14159 / 180), 28));
    }
    CHECK(alone > 1000);
}

// What it is for: as many triangles, but lighting per vertex nearer to lighting per texel where it shines.
TEST_CASE(
    "Highlight Test: per-vertex highlights are better than those of a finer mesh of as many triangles") {
    Job job = functional_job();
    const MachineSetup with = setup_of(with_highlight(job));
    const MachineSetup without = setup_of(job);
    const EmittedMesh highlighted = bare_mesh(with);
    job.tests.normal_threshold = 0.1;
    const MachineSetup finer = setup_of(job);
    const EmittedMesh finer_mesh = bare_mesh(finer);
    CHECK(finer_mesh.triangles.size() >= highlighted.triangles.size());

    const GoldenInputs inputs(with);
    Highlight highlight;
    const auto& half = with.registers.tests.half_vector;
    highlight.half_vector =
        glm::normalize(Dequantise(with.registers.formats).direction({half[0], half[1], half[2]}));
    const GouraudError on = measure_gouraud(highlighted, with, inputs, highlight);
    const GouraudError off = measure_gouraud(bare_mesh(without), without, inputs, highlight);
    const GouraudError fine = measure_gouraud(finer_mesh, finer, inputs, highlight);
    WARN("triangles " << highlighted.triangles.size() << " with, " << finer_mesh.triangles.size()
                      << " finer; RMS in the highlight " << off.highlight_rms << " without, "
                      << on.highlight_rms << " with, " << fine.highlight_rms << " finer; everywhere "
                      << off.rms << ", " << on.rms << ", " << fine.rms);
    CHECK(on.highlight_rms < 0.7 * off.highlight_rms);
    CHECK(on.highlight_rms < 0.8 * fine.highlight_rms);
    CHECK(on.highlight_triangles > 2 * off.highlight_triangles);
    CHECK(on.highlight_triangles > 2 * on.other_triangles);
}

TEST_CASE("per-vertex against per-texel light: a flat mesh has no error, a coarse one that of its middle") {
    Job job = functional_job();
    job.map.source = MapSource::constant;
    job.map.width = job.map.height = 32;
    const MachineSetup flat = setup_of(job);
    Highlight highlight;
    const GouraudError none = measure_gouraud(bare_mesh(flat), flat, GoldenInputs(flat), highlight);
    CHECK(none.texels >= 32 * 32);
    CHECK(none.texels == none.highlight_texels);
    CHECK(none.largest < 1e-9);
    // Corners lit as if they faced away: every texel is off by the whole light.
    EmittedMesh dark = bare_mesh(flat);
    for (EmittedTriangle& triangle : dark.triangles)
        for (auto& corner : triangle.corners)
            corner.displaced_normal = {1 << 14, 0, 0};
    const GouraudError all = measure_gouraud(dark, flat, GoldenInputs(flat), highlight);
    CHECK(all.rms == Approx(1));
    CHECK(all.highlight_rms == Approx(1));
}
