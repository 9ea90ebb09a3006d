#include "testbench/output/report/timing_statistics.h"

#include <fmt/core.h>

#include <utility>

#include "modules/datapath/pack_triangle.h"
#include "testbench/machine/totals.h"
#include "testbench/output/report/ratio.h"
#include "testbench/output/report/timing_report.h"

namespace tessera {

namespace {

class Group {
  public:
    Group(std::vector<Figure>& figures, std::string name) : figures_(figures), name_(std::move(name)) {}

    void count(std::string name, std::uint64_t value, const char* unit, std::string description) {
        figures_.push_back({name_, std::move(name), value, unit, std::move(description)});
    }
    void real(std::string name, double value, const char* unit, std::string description) {
        figures_.push_back({name_, std::move(name), value, unit, std::move(description)});
    }
    void text(std::string name, std::string value, std::string description) {
        figures_.push_back({name_, std::move(name), std::move(value), "", std::move(description)});
    }

  private:
    std::vector<Figure>& figures_;
    std::string name_;
};

void run_figures(const Simulation& simulation, std::vector<Figure>& figures) {
    const Pipeline& p = simulation.last_machine().pipeline;
    const Totals totals(simulation);
    const DecidingUnit::Counts& counts = totals.counts;
    const std::uint64_t cycles = simulation.cycles();
    const Bottleneck bottleneck = find_bottleneck(p, cycles);
    Group run(figures, "timing");
    run.count("cycles", cycles, "cycle", "from the start to the end of the last in which anything happened");
    run.count("clock_period", simulation.setup.design.timing.cycle_picoseconds, "ps", "one cycle");
    run.real("time", static_cast<double>(cycles) * simulation.setup.design.timing.cycle_picoseconds * 1e-12, "s",
             "cycles times the clock's period");
    run.real("cycles_per_triangle", ratio(cycles, counts.finished), "cycle/triangle", "per finished triangle");
    run.real("cycles_per_pass", ratio(cycles, counts.passes), "cycle/pass", "per triangle that went through the tests");
    run.real("cycles_per_edge", ratio(cycles, counts.edges_tested), "cycle/edge", "per edge tested");
    run.real("base_triangle_share", ratio(totals.host_triangles, totals.host_triangles + totals.queue_triangles), "",
             "base triangles in all triangles that Get Triangle took");
    run.count("most_triangles_ahead_of_parts", p.most_ahead_of_parts(), "triangle",
              "that waited for their first part where its parts come together");
    run.text(
        "bottleneck", bottleneck.binding ? bottleneck.first.names() : "none",
        "the units or memories of the highest utilisation, if that is at least 85 %; none: latency binds; of several "
        "machines, in the last to finish");
    run.real("bottleneck_bound", bottleneck.bound(), "times",
             "how many times faster at most without it, or, if latency binds, without any wait");
    run.text("bottleneck_in_words", bottleneck_text(p, cycles), "why");
}

/// What a queue or a wire, which does no work, does not have.
void state_figures(const Unit& unit, std::uint64_t cycles, Group& group) {
    const Activity& activity = unit.activity();
    group.count("busy", activity.cycles_in(State::busy), "cycle", "working on an item that has all it needs");
    group.count("starved", activity.cycles_in(State::starved), "cycle",
                "nothing to work on, or the other branch's results are still to come");
    group.count("waiting_for_memory", activity.cycles_in(State::waiting_for_memory), "cycle",
                "no item has all it needs; table entries have been asked for and have not come");
    group.count("blocked", activity.cycles_in(State::blocked), "cycle", "a finished item is not taken");
    for (const Activity::Share& share : activity.shares()) {
        if (share.by == nullptr || share.cycles == 0)
            continue;
        const char* const what = share.state == State::blocked              ? "blocked_by_"
                                 : share.state == State::waiting_for_memory ? "waiting_for_"
                                                                            : "starved_of_";
        group.count(what + unit_name(*share.by), share.cycles, "cycle", "of these");
    }
    group.real("utilisation", utilisation(unit, cycles), "1",
               "throughput used, of the most possible: items times initiation interval, or port slots taken");
}

void unit_figures(const Unit& unit, std::uint64_t cycles, std::vector<Figure>& figures) {
    const Activity& activity = unit.activity();
    Group group(figures, "timing." + unit_name(unit));
    group.count("items", activity.items_in(), "item", "taken; in a memory, requests");
    group.count("items_out", activity.items_out(), "item", "finished and handed on, or dropped as not needed");
    if (!is_queue_or_wire(unit))
        state_figures(unit, cycles, group);
    group.real("throughput", ratio(activity.items_out(), cycles), "item/cycle", "items out per cycle");
    group.real("occupancy", ratio(activity.item_cycles(), cycles), "item", "items in the unit, on average");
    group.real("latency", ratio(activity.item_cycles(), activity.items_out()), "cycle",
               "an item's stay in the unit, on average");
    group.count("high_water_mark", activity.high_water_mark(), "item", "most at a time");
}

void queue_figures(const Simulation& simulation, const TriangleQueue& queue, std::vector<Figure>& figures) {
    const std::uint64_t entry = datapath::packed_triangle_bytes(simulation.setup.registers.formats);
    Group group(figures, "timing." + unit_name(queue));
    group.count("capacity", simulation.setup.design.queue.capacity, "triangle", "on chip; 0: unbounded");
    group.count("on_chip_high_water_mark", queue.on_chip_high_water_mark(), "triangle",
                "most on chip, one on its way out not counted");
    group.count("spilled", queue.spilled(), "triangle", "written to off-chip memory");
    group.count("refilled", queue.refilled(), "triangle", "read back");
    group.count("spill_bytes", (queue.spilled() + queue.refilled()) * entry, "byte", "both directions");
}

}  // namespace

std::vector<Figure> timing_figures(const Simulation& simulation) {
    std::vector<Figure> figures;
    run_figures(simulation, figures);
    for (const auto& machine : simulation.machines) {
        for (const Unit* unit : machine->pipeline.units()) {
            unit_figures(*unit, simulation.cycles(), figures);
            if (unit == &machine->pipeline.triangle_queue)
                queue_figures(simulation, machine->pipeline.triangle_queue, figures);
        }
    }
    return figures;
}

}  // namespace tessera
