#include "testbench/tests/modules/device/bench.h"

// The device with time resolutions of SystemC other than the default of 1 ps. A separate program, since the constants
// of other tests fix the resolution before main.

using namespace tessera;
using namespace tessera::testing;

namespace {

/// Compares a frame of timed mode with the testbench's.
void expect_frames(double resolution, sc_core::sc_time_unit unit) {
    sc_core::sc_set_time_resolution(resolution, unit);
    const MachineSetup setup = setup_of(small_job(true, "tests.generation_limit=3"));
    Reference reference("reference", setup);
    const datapath::Registers initial = formats_of(setup);
    Bench bench({initial}, design_of(setup));
    const FramePlaces places = bench.place(setup, 30);
    LitKeys found;
    sc_core::sc_time access;
    bench.cpu.program = [&](Processor& cpu) {
        tessera_driver& driver = bench.init();
        cpu.keeper.sync();
        const sc_core::sc_time before = sc_core::sc_time_stamp();
        std::uint32_t value = 0;
        REQUIRE(cpu.read32(Router::registers, value) == 0);
        cpu.keeper.sync();
        access = sc_core::sc_time_stamp() - before;
        set_frame(driver, setup, places);
        found = run_frame(driver);
    };
    bench.run();
    CHECK(access == sc_core::sc_time(5, sc_core::SC_NS));
    CHECK(found.size() > 20);
    expect_same(found, reference.keys);
}

}  // namespace

TEST_CASE("a device under a time resolution of 1 fs") {
    expect_frames(1, sc_core::SC_FS);
}
TEST_CASE("a device under a time resolution of 1 ps") {
    expect_frames(1, sc_core::SC_PS);
}
TEST_CASE("a device under a time resolution of 1 ns, with a period of whole nanoseconds") {
    expect_frames(1, sc_core::SC_NS);
}
TEST_CASE("a device under a time resolution of 1 ns, with a period of 2.5 ns: an error names the device") {
    sc_core::sc_set_time_resolution(1, sc_core::SC_NS);
    Job job = small_job(true);
    job.timing.cycle_picoseconds = 2500;
    const MachineSetup setup = setup_of(job);
    CHECK_THAT(error_of([&] { const Device device("device", setup.registers, design_of(setup)); }),
               Catch::Contains("device.machine: a clock period of 2500 ps"));
}
