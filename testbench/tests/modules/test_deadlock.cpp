#include <catch2/catch.hpp>
#include <string>

#include "testbench/common/error.h"
#include "testbench/tests/support/timed_checks.h"
#include "testbench/tests/support/timed_modules.h"

// A machine that cannot continue reports a deadlock: what each unit holds, and which unit it waits for.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;

namespace {

/// The line of a report that begins with a unit's name.
std::string line_of(const std::string& report, const std::string& unit) {
    const std::size_t begin = report.find("tessera." + unit + ":");
    return begin == std::string::npos ? std::string{} : report.substr(begin, report.find('\n', begin) - begin);
}

/// The cycles in the four states add up also for a run that did not drain.
void require_cycles_add_up(const Simulation& simulation) {
    for (const Unit* unit : simulation.machine.units())
        testing::require_cycles_add_up(*unit, simulation.cycles());
}

Job full_queue_job(QueueOverflow overflow) {
    Job job = timed_job();
    job.hardware.queue.capacity = 8;
    job.hardware.queue.overflow = overflow;
    return job;
}

}  // namespace

// First in first out, eight places. When the queue is full, Tessellation keeps a child; Pass or Tessellate keeps what
// Tessellation does not take; the tests and Transform keep what Pass or Tessellate does not take; Get Triangle keeps a
// triangle whose parts are not taken; and the queue's first triangle waits for Get Triangle: the cycle of waiting units
// is closed.
TEST_CASE("a full queue that stalls is a deadlock, reported unit by unit") {
    const MachineSetup setup = setup_of(full_queue_job(QueueOverflow::stall));
    Simulation simulation(setup, 1'000'000, 1'000'000);
    const std::string report = simulation.run();
    INFO(report);
    CHECK_THAT(report, Catch::StartsWith("deadlock: "));
    CHECK_FALSE(simulation.machine.clock.stalled());
    CHECK(simulation.machine.clock.idle());
    CHECK_THAT(report, Contains("18 base triangles"));
    CHECK_THAT(line_of(report, "triangle_queue"), Contains("triangles") &&
                                                      Contains("no room for the next (capacity 8)") &&
                                                      Contains("waits for get_triangle"));
    CHECK_THAT(line_of(report, "tessellation"), Contains("waits for triangle_queue"));
    CHECK_THAT(line_of(report, "pass_or_tessellate"), Contains("waits for tessellation"));
    CHECK_THAT(line_of(report, "get_triangle"), Contains("partly sent"));
    CHECK(simulation.machine.triangle_queue.on_chip_high_water_mark() == 8 + 1);
    require_cycles_add_up(simulation);
    CHECK(simulation.machine.passes_under_way() > 0);
    // an idle unit is not listed
    CHECK(line_of(report, "lighting").empty());
    CHECK(line_of(report, "off_chip_memory").empty());
}

TEST_CASE("a full queue that spills is not a deadlock") {
    TimedRun simulation(setup_of(full_queue_job(QueueOverflow::spill)), 1'000'000);
    CHECK(simulation.machine.triangle_queue.spilled() > 0);
}

TEST_CASE("a full queue that may not overflow ends the run with an error that names the key") {
    const MachineSetup setup = setup_of(full_queue_job(QueueOverflow::error));
    Simulation simulation(setup, 1'000'000, 1'000'000);
    try {
        simulation.run();
        FAIL("no error");
    } catch (const ResourceError& error) {
        CHECK_THAT(error.what(), Contains("hardware.queue_capacity = 8") && Contains("hardware.queue_order") &&
                                     Contains("hardware.queue_overflow"));
    }
}

TEST_CASE("a full queue, last in first out, with random stalls: a deadlock, not a crash") {
    Job job = full_queue_job(QueueOverflow::stall);
    job.hardware.queue.order = TriangleOrder::lifo;
    job.hardware.queue.capacity = 1;
    job.timing.stalls = {7, 300, 16};
    const MachineSetup setup = setup_of(job);
    Simulation simulation(setup, 1'000'000, 1'000'000);
    const std::string report = simulation.run();
    CHECK_THAT(report, Catch::StartsWith("deadlock: ") && Contains("tessera.triangle_queue"));
    require_cycles_add_up(simulation);
}

// The first decision takes 86 cycles, and units are called in more than 20 of them.
TEST_CASE("a machine that works and decides nothing within the bound is a livelock") {
    const MachineSetup setup = setup_of(timed_job());
    Simulation simulation(setup, 1'000'000, 20);
    const std::string report = simulation.run();
    INFO(report);
    CHECK_THAT(report, Catch::StartsWith("livelock: ") && Contains("limits.cycles_without_progress = 20"));
    CHECK(simulation.machine.clock.stalled());
    require_cycles_add_up(simulation);
}

// Every item on every channel is stalled for up to a million cycles: slow, but each call makes progress.
TEST_CASE("a machine that waits for a million cycles is not a livelock") {
    Job job = one_quad_job();
    job.timing.stalls = {1, 1000, 1'000'000};
    TimedRun simulation(setup_of(job), 500);
    CHECK(simulation.cycles() > 1'000'000);
}

// First in first out: all of a generation is decided before any of the next, so the first triangle is lit after 18 * (1
// + 4 + 16 + 64) passes of 36 cycles.
TEST_CASE("a decided triangle is progress, even if none is lit for a long time") {
    TimedRun simulation(setup_of(full_split_job(3, 4)), 1000);
    CHECK(simulation.cycles() > 1530 * 36);
}

// Lighting takes 500 cycles per triangle and has places for all that wait for it: most are lit long after the last is
// decided, and for each, units are called in more than one cycle.
TEST_CASE("a lit triangle is progress, even if no more are decided") {
    MachineSetup setup = setup_of(full_split_job(2, 2));
    setup.design.timing.lighting = {4, 500, 128};
    TimedRun simulation(setup, 100);
    CHECK(simulation.rasteriser.triangles() == 128);
    CHECK(simulation.cycles() > 127 * 500);
}

TEST_CASE("a run that just meets the bound on progress is not ended") {
    TimedRun simulation(one_triangle(), 46);
}

namespace {

/// Keeps one triangle waiting at its input for ever.
struct Wall : sc_core::sc_module, CycleProcess {
    StreamInput<LitTriangle> in{"in"};
    Wall(const sc_core::sc_module_name& name, CycleScheduler& clock) : sc_module(name) {
        clock.attach(*this);
        in.clocked_by(clock, *this, 1, {});
    }
    void step() override {}
};

}  // namespace

// Behind a rasteriser that takes only one triangle, units fill up one after another, back to the host.
TEST_CASE("a rasteriser that stops taking triangles causes a deadlock back to the queue") {
    const MachineSetup setup = setup_of(full_split_job(3, 2));
    Machine machine("tessera", setup.registers, setup.design);
    Host host("host", machine, setup.base_triangles, tables_of(setup));
    Wall wall("wall", machine.clock);
    host.bind();
    machine.lighting.to_rasteriser.bind(wall.in);
    sc_core::sc_start();
    CHECK(machine.clock.idle());
    CHECK_FALSE(machine.idle());
    const auto expect_blocked = [](const Unit& unit, const sc_core::sc_object& by) {
        INFO(unit.name());
        CHECK(unit.activity().state() == State::blocked);
        CHECK(unit.activity().by() == &by);
        CHECK_FALSE(unit.describe_contents().empty());
    };
    expect_blocked(machine.lighting, wall);
    expect_blocked(machine.pass_or_tessellate, machine.lighting);
    CHECK(machine.pass_or_tessellate.most_incomplete() == setup.design.timing.pass_or_tessellate.buffer);
    expect_blocked(machine.transform, machine.pass_or_tessellate);
    expect_blocked(machine.get_triangle, machine.calculate_new_p);
    expect_blocked(machine.triangle_queue, machine.get_triangle);
    // register stages hold no more than their capacity
    CHECK(machine.transform.activity().level() <= 20);
    CHECK(machine.lighting.activity().level() == 4);
}
