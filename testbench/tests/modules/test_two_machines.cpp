#include <catch2/catch.hpp>
#include <string>

#include "testbench/tests/modules/named_machine.h"
#include "testbench/tests/support/job_results.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/timed_checks.h"

// Machines of different clocks, modes and designs in one simulation: each behaves as it does alone.

using namespace tessera;
using namespace tessera::testing;

namespace {

Job three_tests_units_job() {
    return with_settings(full_split_job(3, 3),
                         "timing.clock_period=3200 hardware.tests_units=3 hardware.queue_capacity=16");
}

const JobResult default_result = result_of("half_donut");

/// Requires exactly one notification, in the last cycle of its own clock.
void expect_drained_in_last_cycle(const NamedMachine& machine) {
    INFO(machine.name());
    REQUIRE(machine.drained.size() == 1);
    CHECK(machine.drained[0] ==
          machine.machine.clock.period() * static_cast<double>(machine.machine.clock.last_cycle()));
}

struct EdgeCounter : sc_core::sc_module {
    std::uint64_t edges = 0;

    EdgeCounter(const sc_core::sc_module_name& name, const sc_core::sc_clock& clock) : sc_module(name) {
        SC_HAS_PROCESS(EdgeCounter);
        SC_METHOD(count);
        dont_initialize();
        sensitive << clock.posedge_event();
    }

  private:
    void count() { ++edges; }
};

/// A queue that fills up; `overflow` selects the reaction.
MachineSetup full_queue_setup(const std::string& overflow) {
    return setup_of(with_settings(timed_job(), "hardware.queue_capacity=8 hardware.queue_overflow=" + overflow));
}

}  // namespace

TEST_CASE("three machines: one with 5 ns, one with 3.2 ns and three Tessellation Tests units, one functional") {
    const MachineSetup slow_setup = setup_of(timed_job());
    const MachineSetup fast_setup = setup_of(three_tests_units_job());
    const MachineSetup functional_setup = setup_of(with_settings(three_tests_units_job(), "mode=functional"));
    const AloneResult fast_alone = run_alone(fast_setup), functional_alone = run_alone(functional_setup);

    NamedMachine slow("slow", slow_setup), fast("fast", fast_setup), functional("functional", functional_setup);
    sc_core::sc_start();
    for (const NamedMachine* machine : {&slow, &fast, &functional})
        expect_bare_mesh(*machine);
    CHECK(slow.cycles() == default_result.cycles);
    CHECK(fast.cycles() == fast_alone.cycles);
    CHECK(functional.machine.clock.last_cycle() == 0);
    CHECK(slow.machine.clock.period() == sc_core::sc_time(5000, sc_core::SC_PS));
    CHECK(fast.machine.clock.period() == sc_core::sc_time(3200, sc_core::SC_PS));
    expect_drained_in_last_cycle(slow);
    expect_drained_in_last_cycle(fast);
    CHECK(fast.drained[0].value() == fast_alone.drained);
    CHECK(fast.drained[0] < slow.drained[0]);
    CHECK(functional.drained.back().value() == functional_alone.drained);
    CHECK(functional.drained.back() != fast.drained[0]);
}

TEST_CASE("two machines: a queue that overflows, or stalls, stops only its own machine") {
    const MachineSetup overflow_setup = full_queue_setup("error");
    const MachineSetup stall_setup = full_queue_setup("stall");
    const MachineSetup sound_setup = setup_of(three_tests_units_job());
    const AloneResult alone = run_alone(sound_setup);

    NamedMachine overflowing("overflowing", overflow_setup);
    NamedMachine stalling("stalling", stall_setup);
    NamedMachine sound("sound", sound_setup);
    sc_core::sc_start();
    CHECK(overflowing.machine.triangle_queue.overflowed());
    CHECK(overflowing.machine.clock.halted());
    CHECK_FALSE(stalling.machine.clock.halted());
    CHECK_FALSE(stalling.machine.idle());
    for (const NamedMachine* stuck : {&overflowing, &stalling}) {
        INFO(stuck->name());
        CHECK_FALSE(stuck->finished());
        CHECK(stuck->drained.empty());
        CHECK(stuck->cycles() * stuck->machine.clock.period().value() < alone.drained);
    }
    expect_bare_mesh(sound);
    CHECK(sound.cycles() == alone.cycles);
    expect_drained_in_last_cycle(sound);
}

TEST_CASE("two machines: cycles begin at the rising edges of the platform's clocks") {
    MachineSetup first_setup = setup_of(timed_job()), second_setup = first_setup;
    const sc_core::sc_clock rises("rises", 3, sc_core::SC_NS, 0.5, 1, sc_core::SC_NS, true);
    const sc_core::sc_clock falls("falls", 7, sc_core::SC_NS, 0.3, 11, sc_core::SC_NS, false);
    first_setup.design.clock = &rises;
    second_setup.design.clock = &falls;
    NamedMachine first("first", first_setup), second("second", second_setup);
    const EdgeCounter first_edges("first_edges", rises), second_edges("second_edges", falls);
    for (const auto& [machine, edges] : {std::pair{&first, &first_edges}, {&second, &second_edges}}) {
        while (machine->drained.empty())
            sc_core::sc_start(machine->machine.clock.period());
        CHECK(machine->cycles() == default_result.cycles);
        expect_bare_mesh(*machine);
        const sc_core::sc_time since = sc_core::sc_time_stamp() - machine->drained[0];
        CHECK(edges->edges - static_cast<std::uint64_t>(since / machine->machine.clock.period()) ==
              default_result.cycles);
    }
    CHECK(first.drained[0] ==
          sc_core::sc_time(1 + 3.0 * static_cast<double>(default_result.cycles - 1), sc_core::SC_NS));
    // The first falling edge at 11 ns, low for 0.7 of the period.
    CHECK(second.drained[0] ==
          sc_core::sc_time(11 + 4.9 + 7.0 * static_cast<double>(default_result.cycles - 1), sc_core::SC_NS));
}
