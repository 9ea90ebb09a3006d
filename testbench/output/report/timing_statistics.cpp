#include "testbench/output/report/timing_statistics.h"

#include "modules/datapath/pack_triangle.h"
#include "testbench/machine/totals.h"
#include "testbench/output/report/ratio.h"
#include "testbench/output/report/timing_report.h"

namespace tessera {

namespace {

void run_figures(std::vector<Figure>& all, const Simulation& simulation) {
    const Machine& p = simulation.last_machine().machine;
    const Totals totals(simulation);
    const DecidingUnit::Counts& counts = totals.counts;
    const std::uint64_t cycles = simulation.cycles();
    const Bottleneck bottleneck = find_bottleneck(p, cycles);
    FigureGroup run(all, "timing");
    run.add("cycles", cycles, "cycle", "from the start to the end of the last active cycle");
    run.add("clock_period", simulation.setup.design.timing.cycle_picoseconds, "ps", "one cycle");
    run.add("time", static_cast<double>(cycles) * simulation.setup.design.timing.cycle_picoseconds * 1e-12, "s",
            "cycles times the clock's period");
    run.add("cycles_per_triangle", ratio(cycles, counts.finished), "cycle/triangle", "per finished triangle");
    run.add("cycles_per_pass", ratio(cycles, counts.passes), "cycle/pass", "per triangle that went through the tests");
    run.add("cycles_per_edge", ratio(cycles, counts.edges_tested), "cycle/edge", "per edge tested");
    run.add("base_triangle_share", ratio(totals.host_triangles, totals.host_triangles + totals.queue_triangles), "",
            "base triangles in all triangles that Get Triangle took");
    run.add("most_triangles_ahead_of_parts", p.most_ahead_of_parts(), "triangle",
            "that waited for their first part at the join");
    run.add(
        "bottleneck", bottleneck.binding ? bottleneck.first.names() : "none", "",
        "the units or memories of the highest utilisation, if that is at least 85 %; none: latency binds; of several "
        "machines, in the last to finish");
    run.add("bottleneck_bound", bottleneck.bound(), "times",
            "largest possible speed-up without it or, if latency binds, without any wait");
    run.add("bottleneck_in_words", bottleneck_text(p, cycles), "", "explanation");
}

/// Figures that queues and wires, which do no work, lack.
void state_figures(FigureGroup& group, const Unit& unit, std::uint64_t cycles) {
    const Activity& activity = unit.activity();
    group.add("busy", activity.cycles_in(State::busy), "cycle", "working on an item with all its inputs", cycles);
    group.add("starved", activity.cycles_in(State::starved), "cycle",
              "nothing to work on, or the other branch's results have not arrived", cycles);
    group.add("waiting_for_memory", activity.cycles_in(State::waiting_for_memory), "cycle",
              "no item has all its inputs; table entries were requested and have not arrived", cycles);
    group.add("blocked", activity.cycles_in(State::blocked), "cycle", "a finished item is not taken", cycles);
    for (const Activity::Share& share : activity.shares()) {
        if (share.by == nullptr || share.cycles == 0)
            continue;
        const char* const what = share.state == State::blocked              ? "blocked_by_"
                                 : share.state == State::waiting_for_memory ? "waiting_for_"
                                                                            : "starved_of_";
        group.add(what + unit_name(*share.by), share.cycles, "cycle", "of these", cycles);
    }
    group.add("utilisation", utilisation(unit, cycles), "1",
              "throughput as a fraction of the maximum: items times initiation interval, or port slots taken");
}

void unit_figures(std::vector<Figure>& all, const Unit& unit, std::uint64_t cycles) {
    const Activity& activity = unit.activity();
    FigureGroup group(all, "timing", unit_name(unit));
    group.add("items", activity.items_in(), "item", "taken; in a memory, requests");
    group.add("items_out", activity.items_out(), "item", "finished and sent on, or dropped as not needed");
    if (!is_queue_or_join(unit))
        state_figures(group, unit, cycles);
    group.add("throughput", ratio(activity.items_out(), cycles), "item/cycle", "items out per cycle");
    group.add("occupancy", ratio(activity.item_cycles(), cycles), "item", "items in the unit, on average");
    group.add("latency", ratio(activity.item_cycles(), activity.items_out()), "cycle",
              "time of an item in the unit, on average");
    group.add("high_water_mark", activity.high_water_mark(), "item", "most at a time");
}

void queue_figures(std::vector<Figure>& all, const Simulation& simulation, const TriangleQueue& queue) {
    const std::uint64_t entry = datapath::packed_triangle_bytes(simulation.setup.registers.formats);
    FigureGroup group(all, "timing", unit_name(queue));
    group.add("capacity", simulation.setup.design.queue.capacity, "triangle", "on chip; 0: unbounded");
    group.add("on_chip_high_water_mark", queue.on_chip_high_water_mark(), "triangle",
              "most on chip, those on their way out included; the high-water mark, unless triangles were spilled");
    group.add("spilled", queue.spilled(), "triangle", "written to off-chip memory");
    group.add("refilled", queue.refilled(), "triangle", "read back");
    group.add("spill_bytes", (queue.spilled() + queue.refilled()) * entry, "byte", "both directions");
}

}  // namespace

void timing_figures(std::vector<Figure>& all, const Simulation& simulation) {
    run_figures(all, simulation);
    for (const auto& hosted : simulation.machines) {
        for (const Unit* unit : hosted->machine.units()) {
            unit_figures(all, *unit, simulation.cycles());
            if (unit == &hosted->machine.triangle_queue)
                queue_figures(all, simulation, hosted->machine.triangle_queue);
        }
    }
}

}  // namespace tessera
