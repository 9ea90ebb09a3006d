#include <catch2/catch.hpp>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/machine/simulation.h"
#include "testbench/tests/support/count_allocations.h"
#include "testbench/tests/support/timed_checks.h"

// No allocations per edge in steady state: in a second frame of the same job every buffer is large enough.

using namespace tessera;
using tessera::testing::setup_of;

namespace {

void expect_no_allocation(const MachineSetup& setup, Simulation& simulation) {
    REQUIRE(simulation.run().empty());
    const std::uint64_t edges = simulation.machine.edges_tested();
    REQUIRE(edges > 50'000);
    simulation.monitor.mesh.triangles.clear();
    const std::uint64_t before = allocations_so_far();
    simulation.host.send_again();
    REQUIRE(simulation.run().empty());
    const std::uint64_t used = allocations_so_far() - before;
    CAPTURE(used, setup.base_triangles.size());
    CHECK(simulation.machine.edges_tested() == 2 * edges);
    // the kernel allocates occasionally when a thread waits: far less than once per thousand edges
    CHECK(used < edges / 1000);
}

void expect_no_allocation_checked(const Job& job) {
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    const GoldenInputs golden(setup);
    Scoreboard scoreboard(setup.registers, golden);
    simulation.machine.pass_or_tessellate.decided.bind(scoreboard);
    expect_no_allocation(setup, simulation);
}

}  // namespace

TEST_CASE("functional mode allocates nothing per edge") {
    Job job;
    job.mode = Mode::functional;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    expect_no_allocation(setup, simulation);
}

TEST_CASE("functional mode with the scoreboard allocates nothing per edge") {
    Job job;
    job.mode = Mode::functional;
    expect_no_allocation_checked(job);
}

TEST_CASE("functional mode with a Highlight Test and the scoreboard allocates nothing per edge") {
    Job job;
    job.mode = Mode::functional;
    job.tests.highlight = true;
    expect_no_allocation_checked(job);
}

TEST_CASE("timed mode allocates nothing per edge") {
    Job job;
    job.mode = Mode::timed;
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    expect_no_allocation(setup, simulation);
}

TEST_CASE("timed mode with three tests units, stalls and a queue that spills allocates nothing per edge") {
    Job job;
    job.mode = Mode::timed;
    job.hardware.tests_units = 3;
    job.hardware.queue.capacity = 100;
    job.timing.stalls = {1, 100, 16};
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000);
    expect_no_allocation(setup, simulation);
    CHECK(simulation.machine.triangle_queue.spilled() > 1000);
}
