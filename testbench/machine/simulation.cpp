#include "testbench/machine/simulation.h"

#include <fmt/core.h>

#include <algorithm>
#include <new>
#include <string_view>

#include "testbench/common/error.h"

namespace tessera {

namespace {

/// Cycles between two returns to the kernel; a stop takes effect at the next return.
constexpr unsigned cycles_ahead = 1024;

std::vector<std::unique_ptr<HostedMachine>> make_machines(const MachineSetup& setup, MeshMonitor& monitor,
                                                          UnitFactory* units) {
    std::vector<std::unique_ptr<HostedMachine>> machines;
    for (std::size_t number = 0; number < setup.machines; ++number)
        machines.push_back(std::make_unique<HostedMachine>(setup, number, monitor, units));
    return machines;
}

}  // namespace

Simulation::Simulation(const MachineSetup& its_setup, std::uint64_t triangle_limit,
                       std::uint64_t cycles_without_progress, UnitFactory* units)
    : setup(its_setup),
      monitor("mesh_monitor", setup.registers.back_face_culling, triangle_limit),
      machines(make_machines(setup, monitor, units)),
      only_own_units_(units == nullptr) {
    for (const auto& hosted : machines)
        hosted->machine.clock.halt_without_progress_for(cycles_without_progress);
}

void Simulation::observe_decisions(tlm::tlm_analysis_if<datapath::TrianglePass>& sink) {
    for (const auto& hosted : machines) {
        hosted->machine.pass_or_tessellate.decided.bind(sink);
        hosted->machine.tessellation.inserted.bind(sink);
    }
}

const HostedMachine& Simulation::last_machine() const {
    const auto earlier = [](const auto& a, const auto& b) { return a->last_cycle() < b->last_cycle(); };
    return **std::max_element(machines.begin(), machines.end(), earlier);
}

std::uint64_t Simulation::sent() const {
    std::uint64_t sum = 0;
    for (const auto& hosted : machines)
        sum += hosted->host.sent();
    return sum;
}

namespace {

void start() {
    try {
        sc_core::sc_start();
    } catch (const sc_core::sc_report& report) {
        // The kernel converts exceptions of a process to its own report, and has one for stacks that do not fit, whose
        // type has another name in SystemC 3.
        const std::string_view said = report.get_msg();
        if (said == std::bad_alloc().what() || said == "failed to allocate stack memory")
            throw std::bad_alloc();
        throw;
    }
}

}  // namespace

std::string Simulation::run() {
    if (only_own_units_ && machines.size() == 1)  // other units may depend on simulation time
        machine.clock.run_ahead(cycles_ahead);
    start();
    if (setup.design.transport == Transport::non_blocking) {
        cycles_ = last_machine().last_cycle() + 1;
        for (const auto& hosted : machines)
            hosted->finish(cycles_);
    }
    const datapath::HeightTest height_test = setup.registers.formats.height_test;
    if (monitor.limit_reached())
        throw ResourceError(fmt::format(
            "limits.triangles = {}: the mesh has more triangles than that; raise the thresholds "
            "under [tests], "
            "{}, or raise the limit{}",
            monitor.limit(),
            setup.registers.tests.generation_test ? "lower tests.generation_limit" : "set tests.generation = true",
            is_added(height_test)
                ? fmt::format(". Height test {} is not tessera's: if higher thresholds do not help, its "
                              "decide() asks for too many splits",
                              functions_of(height_test).name)
                : ""));
    for (const auto& hosted : machines)
        check_limits(hosted->machine);
    return stuck();
}

void Simulation::check_limits(const Machine& one) const {
    if (one.clock.out_of_time())
        throw ResourceError(
            fmt::format("timing.clock_period = {} ps: after cycle {} simulated time ends, at 2^64 - 1 ps; lower the "
                        "period, which changes only the figures in seconds, or the latencies under [timing]",
                        setup.design.timing.cycle_picoseconds, one.clock.last_cycle()));
    const char* const fewer =
        setup.design.queue.order == TriangleOrder::fifo ? "; with hardware.queue_order = \"lifo\" far fewer wait" : "";
    if (one.triangle_queue.overflowed())
        throw ResourceError(fmt::format(
            "hardware.queue_capacity = {}: the Triangle Queue was full when a triangle arrived in cycle {}; set "
            "hardware.queue_capacity = 0, without a limit, or hardware.queue_overflow = \"spill\"{}",
            setup.design.queue.capacity, one.clock.last_cycle(), fewer));
    if (one.triangle_queue.off_chip_memory_full())
        throw ResourceError(fmt::format(
            "hardware.off_chip_triangles = {}: in cycle {} a full Triangle Queue (hardware.queue_capacity = "
            "{}) had more to spill; set hardware.queue_capacity = 0, without a limit, or raise "
            "hardware.off_chip_triangles{}",
            setup.design.queue.off_chip_triangles, one.clock.last_cycle(), setup.design.queue.capacity, fewer));
}

std::string Simulation::stuck() const {
    std::string text;
    for (const auto& hosted : machines)
        if (!hosted->drained())
            text += stuck(*hosted, setup);
    return text;
}

std::string Simulation::stuck(const HostedMachine& hosted, const MachineSetup& setup) {
    const Machine& stuck_machine = hosted.machine;
    const Host& host = hosted.host;
    const bool timed = setup.design.transport == Transport::non_blocking;
    const CycleScheduler& clock = stuck_machine.clock;
    std::string text =
        clock.stalled() ? fmt::format(
                              "livelock: for more than limits.cycles_without_progress = {} cycles of work, up to cycle "
                              "{}, no triangle has been decided or lit; if the design is only slow, raise the limit\n",
                              clock.most_without_progress(), clock.last_cycle())
                        : fmt::format("deadlock: no events are pending{}, but work remains\n",
                                      timed ? fmt::format(" after cycle {}", clock.last_cycle()) : std::string{});
    const auto& counts = stuck_machine.pass_or_tessellate.counts();
    text += fmt::format("  host: {} of {} base triangles sent{}\n", host.sent(), host.total(),
                        host.idle() ? "" : ", waits for get_triangle");
    text += fmt::format("  finished: {} triangles\n", counts.finished);
    for (const Unit* unit : stuck_machine.units()) {
        std::string line = unit->describe_contents();
        const Activity& activity = unit->activity();
        const sc_core::sc_object* by = activity.by();
        if (by != nullptr)
            line = listed(
                line,
                fmt::format("waits for {}{}", by->basename(), activity.state() == State::blocked ? " to take it" : ""),
                "; ");
        if (!line.empty())
            text += fmt::format("  {}: {}\n", unit->name(), line);
    }
    if (!clock.stalled() && stuck_machine.triangle_queue.waiting() > 0 && setup.design.queue.capacity > 0 &&
        setup.design.queue.overflow == QueueOverflow::stall)
        text += fmt::format(
            "  a full queue (hardware.queue_capacity = {}) does not spill: set hardware.queue_capacity = 0, without a limit, or "
            "hardware.queue_overflow = \"spill\"\n",
            setup.design.queue.capacity);
    return text;
}

}  // namespace tessera
