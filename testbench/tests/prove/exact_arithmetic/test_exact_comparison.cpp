#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/check/conformance/end_to_end.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/common/error.h"
#include "testbench/prove/exact_arithmetic/exact_comparison.h"
#include "testbench/tests/support/timed_checks.h"

using namespace tessera;
using namespace tessera::testing;

namespace {

Job small_job() {
    Job job;
    job.mode = Mode::functional;
    job.map.width = job.map.height = 48;
    job.displacement.scale = 0.25;
    job.tests.generation_limit = 6;
    return job;
}

Job sphere_job() {
    Job job = small_job();
    job.mesh.source = MeshSource::sphere;
    job.mesh.columns = 8;
    job.mesh.rows = 6;
    job.map.address_u = Addressing::repeat;
    job.displacement.scale = 0.1;
    job.tests.threshold("summed_height_threshold") = 2;  // with 2 displacement bits a step of its register is 1 / 12
    return job;
}

ExactComparison run_of(const Job& job) {
    const auto [mesh, map, resolved] = load_inputs(job);
    return compare_with_exact(make_setup(resolved.job, mesh, map), ExactModel(resolved.job, mesh, map), 1'000'000);
}

/// Compares every figure that `tessera run` has, too.
void expect_the_simulation_figures(const Job& job) {
    const ExactComparison run = run_of(job);
    const MachineSetup setup = setup_of(job);
    const GoldenInputs golden(setup);
    Scoreboard scoreboard(setup.registers, golden);
    Simulation simulation(setup, 1'000'000);
    simulation.machine.pass_or_tessellate.decided.bind(scoreboard);
    REQUIRE(simulation.run().empty());
    EmittedMesh& mesh = simulation.monitor.mesh;
    mesh.sort();
    const ConformanceResult conformance = scoreboard.result();
    const InvariantResult invariants = check_invariants(mesh, setup);
    const EndToEndResult end_to_end = compare_end_to_end(setup, golden, mesh);

    CHECK(run.triangles == mesh.triangles.size());
    CHECK(run.edges == simulation.machine.edges_tested());
    CHECK(run.edges_split == simulation.machine.pass_or_tessellate.counts().edges_split);
    CHECK(run.conformance.edges == conformance.edges);
    CHECK(run.conformance.base_vertices == conformance.base_vertices);
    CHECK(run.conformance.flipped_edges == conformance.flipped_edges);
    CHECK(run.conformance.mismatches == conformance.mismatches);
    REQUIRE(run.conformance.tests.size() == conformance.tests.size());
    for (std::size_t k = 0; k < conformance.tests.size(); ++k) {
        INFO(conformance.tests[k].name);
        CHECK(run.conformance.tests[k].allowed_flips == conformance.tests[k].allowed_flips);
        CHECK(run.conformance.tests[k].compared == conformance.tests[k].compared);
    }
    CHECK(run.invariants.cracks == invariants.cracks);
    CHECK(run.invariants.violations() == invariants.violations());
    CHECK(run.invariants.collapsed == invariants.collapsed);
    CHECK(run.end_to_end.golden_triangles == end_to_end.golden_triangles);
    CHECK(run.end_to_end.hardware_to_golden.max_model == end_to_end.hardware_to_golden.max_model);
    const datapath::Saturations counted = simulation.machine.saturations();
    CHECK(run.saturations.displaced_position == counted.displaced_position);
    CHECK(run.saturations.normal == counted.normal);
    CHECK(run.saturations.screen_position == counted.screen_position);
    CHECK(run.saturations.view_distance == counted.view_distance);
    CHECK(run.saturations.degenerate_normal == counted.degenerate_normal);
    CHECK(run.saturations.generation == counted.generation);
    CHECK(run.saturations.intensity == counted.intensity);
}

}  // namespace

TEST_CASE("exact arithmetic: the figures are the simulation's, narrow normals and positions") {
    Job job = small_job();
    job.formats.normal_bits = 8;
    job.formats.normal_fraction = 6;
    job.formats.position_bits = 14;
    job.formats.position_fraction = 3;
    const ExactComparison run = run_of(job);
    CHECK(run.conformance.flipped_edges > 0);
    CHECK(run.flips_of(Decided::normal) > run.conformance.flipped_edges / 10);
    expect_the_simulation_figures(job);
}
TEST_CASE("exact arithmetic: the figures are the simulation's, a screen that saturates and culling") {
    Job job = small_job();
    job.formats.screen_bits = 13;
    job.formats.screen_fraction = 2;
    job.camera.eye = {0.2, -0.5, 0.4};
    job.hardware.culling = Culling::back;
    job.tests.highlight = true;
    CHECK(run_of(job).saturations.screen_position > 0);
    expect_the_simulation_figures(job);
}
TEST_CASE("exact arithmetic: the figures are the simulation's, full light") {
    Job job = small_job();
    job.map.source = MapSource::constant;
    job.camera.eye = {0, -3, 0};
    job.camera.target = {0, 0, 0};
    job.hardware.light = {0, 0, 1};
    CHECK(run_of(job).saturations.intensity == 54);
    Job culled = job;
    culled.hardware.culling = Culling::back;  // seen edge-on everywhere: nothing is lit
    CHECK(run_of(culled).saturations.intensity == 0);
    expect_the_simulation_figures(job);
}
TEST_CASE("exact arithmetic: the figures are the simulation's, a sphere of few texture bits") {
    Job job = sphere_job();
    job.formats.texture_fraction = 2;
    job.formats.displacement_bits = 5;
    expect_the_simulation_figures(job);
}

TEST_CASE("exact arithmetic: values that the formats hold exactly give the results of exact arithmetic") {
    // a plane of 4 x 4 quads on 64 texels: all coordinates are dyadic, and on a constant map no normal is rounded
    Job job = small_job();
    job.mesh.columns = job.mesh.rows = 4;
    job.map.source = MapSource::constant;
    job.map.value = 0;
    job.map.width = job.map.height = 64;
    job.tests.normal_threshold = 0;
    job.tests.threshold("summed_height_threshold") = 0;
    const ExactComparison whole = run_of(job);
    CHECK(whole.position_max == 0);
    for (const std::uint64_t flips : whole.flips)
        CHECK(flips == 0);

    // heights of one bit: 0 and full scale are exact, one half is not
    job.map.source = MapSource::ramp;
    job.tests.normal_threshold = 0.12;
    job.formats.displacement_bits = 1;
    const ExactComparison steps = run_of(job);
    CHECK(steps.position_max > 0.1 * job.displacement.scale);
    CHECK(steps.position_max <= 0.5 * job.displacement.scale * (1 + 1e-6));
}

TEST_CASE("exact arithmetic: on a flat surface a position's error is the midpoint's rounding") {
    Job job = small_job();
    job.displacement.scale = 0;
    job.displacement.bias = 0;
    job.formats.position_bits = 12;
    job.formats.position_fraction = 2;
    job.tests.threshold("summed_height_threshold") = 0.05;
    const ExactComparison run = run_of(job);
    REQUIRE(run.edges_split > 20);
    // every generation rounds down by at most half an LSB per axis: E_g <= (E_i + E_j) / 2 + 1/2
    const double generations = static_cast<double>(job.tests.generation_limit);
    CHECK(run.position_max > 0);
    CHECK(run.position_max <= run.position_lsb * std::sqrt(2.0) * (0.5 + 0.5 * generations));
    CHECK(run.position_rms <= run.position_max);
}

TEST_CASE("exact arithmetic: more bits give less error and fewer flips") {
    const auto runs = [](std::int64_t Job::Formats::*bits, const std::vector<std::int64_t>& widths, auto fraction) {
        std::vector<ExactComparison> all;
        for (const std::int64_t width : widths) {
            Job job = sphere_job();
            job.formats.*bits = width;
            fraction(job.formats, width);
            all.push_back(run_of(job));
            CHECK(all.back().conformance.mismatches == 0);
            CHECK(all.back().invariants.passed());
        }
        return all;
    };
    const auto normals = runs(&Job::Formats::normal_bits, {18, 14, 10, 7},
                              [](Job::Formats& f, std::int64_t width) { f.normal_fraction = width - 2; });
    const auto positions =
        runs(&Job::Formats::position_bits, {32, 24, 18, 12},
             [](Job::Formats& f, std::int64_t width) { f.position_fraction = std::max<std::int64_t>(0, width - 16); });
    const auto codes = runs(&Job::Formats::displacement_bits, {16, 8, 4, 2}, [](Job::Formats&, std::int64_t) {});
    for (std::size_t k = 1; k < 4; ++k) {
        INFO(k);
        CHECK(normals[k].flips_of(Decided::normal) > normals[k - 1].flips_of(Decided::normal));
        CHECK(positions[k].position_rms >= positions[k - 1].position_rms);
        CHECK(codes[k].position_rms > codes[k - 1].position_rms);
    }
    CHECK(positions[3].position_rms > 10 * positions[0].position_rms);
}

TEST_CASE("exact arithmetic: base triangles that collapse in a narrow format are left out on both sides") {
    Job job = small_job();
    job.mesh.columns = 200;
    job.mesh.rows = 1;
    job.tests.generation_limit = 1;
    job.formats.position_bits = 8;
    job.formats.position_fraction = 2;
    job.formats.texture_fraction = 0;
    const MachineSetup setup = setup_of(job);
    REQUIRE(setup.base_dropped > 0);
    const auto [mesh, map, resolved] = load_inputs(job);
    const ExactModel exact(resolved.job, mesh, map);
    const auto corners = exact.corners_of(setup);
    REQUIRE(corners.size() == setup.base_triangles.size());
    const ExactComparison run = compare_with_exact(setup, exact, 1'000'000);
    // P' of a wrong triangle would be at least a column away; rounding moves it by less than this
    CHECK(run.position_max < 1.0);
    for (std::size_t k = 0; k < corners.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) {
            const double lsb = run.position_lsb;
            const glm::dvec3 rounded = setup.model_scale.to_model(
                Dequantise(setup.registers.formats).position(setup.base_triangles[k].vertices[c].position));
            CHECK(glm::length(rounded - exact.model_scale().to_model(corners[k][c].position)) < 2 * lsb);
        }
}
