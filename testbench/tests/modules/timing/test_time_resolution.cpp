#include <catch2/catch.hpp>
#include <string>

#include "testbench/tests/support/timed_checks.h"
#include "testbench/tests/support/timed_modules.h"

// The clock's period with time resolutions of SystemC other than the default of 1 ps. A separate program, since the
// constants of other tests fix the resolution before main.

using namespace tessera;
using namespace tessera::testing;
using Catch::Contains;
using sc_core::sc_time;

TEST_CASE("time resolution 1 ns: a period of whole nanoseconds is exact") {
    sc_core::sc_set_time_resolution(1, sc_core::SC_NS);
    CHECK(clock_period("machine", 5000) == sc_time(5, sc_core::SC_NS));
}

TEST_CASE("time resolution 1 ns: any other period is an error that names the remedy") {
    sc_core::sc_set_time_resolution(1, sc_core::SC_NS);
    for (const unsigned picoseconds : {1u, 999u, 2500u, 5001u})
        CHECK_THAT(error_of([&] { clock_period("machine", picoseconds); }),
                   Contains("machine: ") && Contains(" " + std::to_string(picoseconds) + " ps") && Contains("1 ns") &&
                       Contains("sc_set_time_resolution"));
}

#if SC_VERSION_MAJOR < 3  // later ones abort at a resolution above the default time unit, 1 ns
TEST_CASE("time resolution 10 s: no period is a multiple of that") {
    sc_core::sc_set_time_resolution(10, sc_core::SC_SEC);
    CHECK_THAT(error_of([] { clock_period("machine", 5000); }), Contains("10 s"));
}
#endif

TEST_CASE("time resolution 1 ns: a machine refuses a period of 2.5 ns, and the error names it") {
    sc_core::sc_set_time_resolution(1, sc_core::SC_NS);
    Job job = full_split_job(1, 1);
    job.timing.cycle_picoseconds = 2500;
    const MachineSetup setup = setup_of(job);
    CHECK_THAT(error_of([&] { const Machine machine("machine", setup.registers, setup.design); }),
               Contains("machine: a clock period of 2500 ps"));
}

namespace {

void expect_time(double resolution, sc_core::sc_time_unit unit) {
    sc_core::sc_set_time_resolution(resolution, unit);
    const MachineSetup setup = setup_of(full_split_job(1, 2));
    Simulation simulation(setup, 1'000'000);
    CHECK(simulation.run().empty());
    CHECK(simulation.cycles() > 1000);
    // 5000 ps per cycle
    CHECK(sc_core::sc_time_stamp() == sc_time(5.0 * static_cast<double>(simulation.cycles() - 1), sc_core::SC_NS));
}

}  // namespace

TEST_CASE("time resolution 1 fs: a run lasts its cycles times the period") {
    expect_time(1, sc_core::SC_FS);
}
TEST_CASE("time resolution 1 ns: a run lasts its cycles times the period") {
    expect_time(1, sc_core::SC_NS);
}
