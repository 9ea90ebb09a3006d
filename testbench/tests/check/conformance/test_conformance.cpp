#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "testbench/check/conformance/end_to_end.h"
#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/conformance/setup_check.h"
#include "testbench/input/map/built_in_maps.h"
#include "testbench/input/map/read_height_map.h"
#include "testbench/input/mesh/make_base_mesh.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/machine/simulation.h"
#include "testbench/tests/support/source_folder.h"

using namespace tessera;

// The whole machine against the golden model, on inputs that no example job has; those: commands/test_jobs.cpp. A
// process can elaborate only once: run one case at a time, as ctest does.
namespace {

const std::filesystem::path jobs = source_folder() / "testbench/examples/jobs";

void expect_conformance(const Job& asked, const HeightMap& map) {
    const BaseMesh mesh = make_base_mesh(asked.mesh, "");
    const Job job = resolve_job(asked, mesh, map).job;
    const MachineSetup setup = make_setup(job, mesh, map);
    const GoldenInputs inputs(setup);
    Scoreboard scoreboard(setup.registers, inputs);
    Simulation simulation(setup, 1000000);
    simulation.machine.pass_or_tessellate.decided.bind(scoreboard);
    REQUIRE(simulation.run().empty());

    const ConformanceResult result = scoreboard.result();
    INFO(result.first_mismatch);
    CHECK(result.mismatches == 0);
    CHECK(result.edges == 3 * simulation.machine.pass_or_tessellate.counts().passes);
    CHECK(result.base_vertices == 3 * setup.base_triangles.size());
    CHECK(result.passed(Job::Check{}.allowed_flips));

    const GoldenJob golden(job, mesh, map, setup.model_scale);
    const SetupResult host = check_setup(setup, golden, simulation);
    INFO(host.first_wrong);
    CHECK(host.passed());
    const EndToEndResult meshes =
        GoldenRun(golden, host.base_triangles).compare(setup, simulation.monitor.mesh, Job::Check{}.allowed_triangles);
    CHECK_FALSE(meshes.bound_hit);
    CHECK(std::abs(meshes.more_triangles()) < Job::Check{}.allowed_triangles);
    CHECK(meshes.passed());
}

Job with_highlight(Job job) {
    job.tests.highlight = true;
    return job;
}

Job head() {
    Job job;
    job.mesh.source = MeshSource::cylinder;
    job.mesh.columns = job.mesh.rows = 30;
    job.mesh.radius = 0.582837;
    job.mesh.height = 5.32;
    job.map.address_u = Addressing::repeat;
    job.displacement.scale = 1.891544222831726;
    job.camera.eye = {0, -6, 0};
    return job;
}

}  // namespace

TEST_CASE("half donut, 1024 texels") {
    expect_conformance(Job{}, half_donut_map(1024, 1024));
}

TEST_CASE("half donut with a Highlight Test, 1024 texels") {
    expect_conformance(with_highlight(Job{}), half_donut_map(1024, 1024));
}

TEST_CASE("noise, with the eye within the heights") {
    Job job;
    job.camera.eye = {0, -0.3, 0.3};
    job.camera.target = {0, 1, 0.2};
    job.tests.generation_limit = 8;
    expect_conformance(job, noise_map(128, 128, 1));
}

TEST_CASE("sphere with repeated map and narrow normals") {
    Job job;
    job.mesh.source = MeshSource::sphere;
    job.mesh.columns = 24;
    job.mesh.rows = 12;
    job.map.address_u = Addressing::repeat;
    job.formats.normal_bits = 12;
    job.formats.normal_fraction = 10;
    job.tests.summed_height_unit = SummedHeightUnit::area;
    job.tests.threshold("summed_height_threshold") = 0.05;
    expect_conformance(job, half_donut_map(128, 128));
}

TEST_CASE("the head on its cylinder with a Highlight Test") {
    expect_conformance(with_highlight(head()), read_height_map(jobs / "head_lee_perry_smith.png"));
}
