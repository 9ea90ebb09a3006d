#include <catch2/catch.hpp>

#include "testbench/check/conservation.h"
#include "testbench/tests/timed_checks.h"

// The work check over whole runs: nothing is lost, doubled or altered, down to what the rasteriser gets.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

void require_work_conserved(const Job& job) {
    const Setup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 1'000'000);
    WorkCheck work(setup.registers, setup.base_triangles);
    simulation.pipeline.pass_or_tessellate.decided.bind(work);
    simulation.pipeline.pass_or_tessellate.finished.bind(work);
    simulation.rasteriser.taken.bind(work);
    REQUIRE(simulation.run().empty());
    const WorkResult result = work_result(work, simulation);
    INFO(result.first_violation);
    CHECK(result.passed());
    CHECK(result.triangles == simulation.pipeline.pass_or_tessellate.counts().passes);
    CHECK(result.equations > 10);

    // The same, but for one triangle that the rasteriser gets twice.
    work.write(LitTriangle{});
    const WorkResult doubled = work_result(work, simulation);
    CHECK(doubled.violations == 1);
    CHECK_THAT(doubled.first_violation, Contains("1 triangles more were lit than were to be"));
}

}  // namespace

TEST_CASE("work is conserved: half donut, functional, culled") {
    Job job;
    job.mode = Mode::functional;
    job.hardware.culling = Culling::back;
    require_work_conserved(job);
}

TEST_CASE("work is conserved: half donut, timed, a queue that spills, three tests units") {
    Job job = timed_job();
    job.hardware.queue_capacity = 16;
    job.hardware.tests_units = 3;
    require_work_conserved(job);
}
