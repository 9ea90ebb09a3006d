#include "testbench/machine/simulation.h"

#include <fmt/core.h>

#include <new>
#include <string_view>

#include "testbench/common/error.h"

namespace tessera {

Simulation::Simulation(const MachineSetup& its_setup, std::uint64_t triangle_limit,
                       std::uint64_t cycles_without_progress, UnitFactory* units)
    : setup(its_setup),
      pipeline("tessera", setup.registers, setup.design, units),
      host("host", setup, pipeline.clock),
      rasteriser("rasteriser", pipeline.clock, setup.design.timing.stalls),
      decisions(setup),
      monitor("mesh_monitor", setup.registers.back_face_culling, triangle_limit) {
    if (units != nullptr)
        units->made(host);
    host.to_get_triangle.bind(pipeline.get_triangle.from_host);
    host.displacement_map.bind(pipeline.displacement_map.host);
    host.normal_map.bind(pipeline.normal_map.host);
    host.summed_height_table.bind(pipeline.summed_height_table.host);
    pipeline.lighting.to_rasteriser.bind(rasteriser.from_lighting);
    pipeline.pass_or_tessellate.decided.bind(decisions);
    pipeline.pass_or_tessellate.finished.bind(monitor);
    monitor.tags_from(decisions);
    pipeline.clock.halt_without_progress_for(cycles_without_progress);
}

namespace {

void start() {
    try {
        sc_core::sc_start();
    } catch (const sc_core::sc_report& report) {
        // The kernel converts exceptions of a process to its own report.
        if (report.get_msg() == std::string_view(std::bad_alloc().what()))
            throw std::bad_alloc();
        throw;
    }
}

}  // namespace

std::string Simulation::run() {
    start();
    if (setup.design.transport == Transport::non_blocking) {
        cycles_ = pipeline.clock.last_cycle() + 1;
        for (Unit* unit : pipeline.units())
            unit->activity().finish(cycles_);
        pipeline.triangle_queue.history().finish(cycles_);
    }
    if (monitor.limit_reached())
        throw ResourceError(fmt::format(
            "limits.triangles = {}: the mesh has more triangles than that; raise the thresholds "
            "under [tests], "
            "{}, or raise the limit",
            monitor.mesh.triangles.size(),
            setup.registers.tests.generation_test ? "lower tests.generation_limit" : "set tests.generation = true"));
    if (pipeline.clock.out_of_time())
        throw ResourceError(
            fmt::format("timing.clock_period = {} ps: after cycle {} simulated time ends, at 2^64 - 1 ps; lower the "
                        "period, which changes no figure but those in seconds, or the latencies under [timing]",
                        setup.design.timing.cycle_picoseconds, pipeline.clock.last_cycle()));
    const bool fifo = setup.design.queue.order == TriangleOrder::fifo;
    if (pipeline.triangle_queue.overflowed())
        throw ResourceError(
            fmt::format("hardware.queue_capacity = {}: in cycle {} a triangle found the Triangle Queue full; raise the "
                        "capacity, or set {}hardware.queue_overflow = \"spill\"",
                        setup.design.queue.capacity, pipeline.clock.last_cycle(),
                        fifo ? "hardware.queue_order = \"lifo\" or " : ""));
    if (pipeline.triangle_queue.off_chip_memory_full())
        throw ResourceError(fmt::format(
            "hardware.off_chip_triangles = {}: in cycle {} a full Triangle Queue (hardware.queue_capacity = "
            "{}) had more to spill; raise either{}",
            setup.design.queue.off_chip_triangles, pipeline.clock.last_cycle(), setup.design.queue.capacity,
            fifo ? ", or set hardware.queue_order = \"lifo\", which needs far fewer" : ""));
    return drained() ? std::string{} : stuck();
}

bool Simulation::drained() const {
    return host.idle() && pipeline.idle();
}

std::string Simulation::stuck() const {
    const bool timed = setup.design.transport == Transport::non_blocking;
    const CycleScheduler& clock = pipeline.clock;
    std::string text =
        clock.stalled() ? fmt::format(
                              "livelock: for more than limits.cycles_without_progress = {} cycles of work, up to cycle "
                              "{}, no triangle has been decided or lit; if the design is just slow, raise the limit\n",
                              clock.most_without_progress(), clock.last_cycle())
                        : fmt::format("deadlock: the simulation has nothing left to do{}, yet work is left\n",
                                      timed ? fmt::format(" after cycle {}", clock.last_cycle()) : std::string{});
    const auto& counts = pipeline.pass_or_tessellate.counts();
    text += fmt::format("  host: {} of {} base triangles sent{}\n", host.sent(), host.total(),
                        host.idle() ? "" : ", waits for get_triangle");
    text += fmt::format("  finished: {} triangles\n", counts.finished);
    for (const Unit* unit : pipeline.units()) {
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
    if (!clock.stalled() && pipeline.triangle_queue.waiting() > 0 && setup.design.queue.capacity > 0 &&
        setup.design.queue.overflow == QueueOverflow::stall)
        text += fmt::format(
            "  a full queue may not spill: raise hardware.queue_capacity = {}, or set "
            "hardware.queue_overflow = \"spill\"\n",
            setup.design.queue.capacity);
    return text;
}

}  // namespace tessera
