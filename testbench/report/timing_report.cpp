#include "testbench/report/timing_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <vector>

namespace tessera {

namespace {

double percent(double part, double whole) {
    return whole > 0 ? 100 * part / whole : 0;
}

double state_percent(const Unit& unit, State state, std::uint64_t cycles) {
    return percent(static_cast<double>(unit.activity().cycles_in(state)), static_cast<double>(cycles));
}

bool is_memory(const Unit& unit) {
    return dynamic_cast<const TableMemory*>(&unit) != nullptr ||
           dynamic_cast<const OffChipMemory*>(&unit) != nullptr;
}

/// The largest share of a state that names somebody: who blocks, is waited for or lacks.
const Activity::Share* largest_share(const Unit& unit, State state) {
    const Activity::Share* largest = nullptr;
    for (const Activity::Share& share : unit.activity().shares()) {
        if (share.by != nullptr && share.state == state &&
            (largest == nullptr || share.cycles > largest->cycles))
            largest = &share;
    }
    return largest;
}

std::string whom(const Unit& unit) {
    std::string text;
    for (const State state : {State::blocked, State::waiting_for_memory, State::starved}) {
        const Activity::Share* share = largest_share(unit, state);
        if (share == nullptr || share->cycles == 0)
            continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ",
                            state == State::blocked              ? "blocked by"
                            : state == State::waiting_for_memory ? "waits for"
                                                                 : "lacks",
                            unit_name(*share->by));
    }
    return text;
}

}  // namespace

std::string unit_name(const sc_core::sc_object& unit) {
    const std::string name = unit.name();
    const std::size_t dot = name.find('.');
    return dot == std::string::npos ? name : name.substr(dot + 1);
}

double utilisation(const Unit& unit, std::uint64_t cycles) {
    // The last item's interval may reach beyond the run's end.
    const std::uint64_t occupied = std::min(unit.occupied_cycles(), cycles);
    return cycles == 0 ? 0 : static_cast<double>(occupied) / static_cast<double>(cycles);
}

Bottleneck find_bottleneck(const Simulation& simulation) {
    Bottleneck found;
    for (const Unit* unit : simulation.pipeline.units()) {
        const double of_it = utilisation(*unit, simulation.cycles());
        if (found.unit == nullptr || of_it > found.utilisation) {
            found.next = found.unit;
            found.next_utilisation = found.utilisation;
            found.unit = unit;
            found.utilisation = of_it;
        } else if (found.next == nullptr || of_it > found.next_utilisation) {
            found.next = unit;
            found.next_utilisation = of_it;
        }
    }
    found.binding = found.utilisation >= binding_utilisation;
    return found;
}

std::string bottleneck_text(const Simulation& simulation) {
    const std::uint64_t cycles = simulation.cycles();
    const Bottleneck found = find_bottleneck(simulation);
    if (found.unit == nullptr || cycles == 0)
        return "nothing was done";
    const Unit& get = simulation.pipeline.get_triangle;
    if (!found.binding)
        return fmt::format(
            "none: the most taken, {}, is so in {:.1f} % of all cycles; too few triangles were under way "
            "to hide the latencies (get_triangle starved {:.1f} %, blocked {:.1f} %)",
            unit_name(*found.unit), 100 * found.utilisation, state_percent(get, State::starved, cycles),
            state_percent(get, State::blocked, cycles));
    std::string text =
        fmt::format("{}: {} in {:.1f} % of all cycles", unit_name(*found.unit),
                    is_memory(*found.unit) ? "its ports are taken" : "it has no room for more work",
                    100 * found.utilisation);
    const Unit* waiting = nullptr;
    std::uint64_t most = 0;
    for (const Unit* unit : simulation.pipeline.units()) {
        for (const Activity::Share& share : unit->activity().shares()) {
            if (share.by == found.unit && share.cycles > most) {
                most = share.cycles;
                waiting = unit;
            }
        }
    }
    if (waiting != nullptr)
        text += fmt::format("; {} waits for it {:.1f} %", unit_name(*waiting),
                            percent(static_cast<double>(most), static_cast<double>(cycles)));
    if (found.next != nullptr && found.next_utilisation > 0)
        text += fmt::format("; without it the next limit is {}, at {:.1f} % now: up to {:.1f} times faster",
                            unit_name(*found.next), 100 * found.next_utilisation,
                            found.utilisation / found.next_utilisation);
    return text;
}

std::string timing_text(const Simulation& simulation) {
    const std::uint64_t cycles = simulation.cycles();
    std::string text = fmt::format(
        "{} cycles. Every cycle of a unit is one of busy, starved (nothing to do, or the other half is "
        "lacking),\n"
        "blocked (a finished item is not taken), memory (waiting for table entries); in per cent of all "
        "cycles.\n"
        "utilisation: cycles in which no more work could have been taken. occupancy: items in the unit, on "
        "average.\n\n"
        "{:<40}{:>10}{:>8}{:>9}{:>9}{:>8}{:>13}{:>11}{:>9}{:>6}  {}\n",
        cycles, "unit", "items", "busy", "starved", "blocked", "memory", "utilisation", "items/kcyc",
        "occup.", "most", "by whom");
    for (const Unit* unit : simulation.pipeline.units()) {
        const Activity& activity = unit->activity();
        std::string line = fmt::format(
            "{:<40}{:>10}{:>8.2f}{:>9.2f}{:>9.2f}{:>8.2f}{:>13.2f}{:>11.2f}{:>9.3f}{:>6}  {}",
            unit_name(*unit), activity.items_in(), state_percent(*unit, State::busy, cycles),
            state_percent(*unit, State::starved, cycles), state_percent(*unit, State::blocked, cycles),
            state_percent(*unit, State::waiting_for_memory, cycles), 100 * utilisation(*unit, cycles),
            1000 * percent(static_cast<double>(activity.items_in()), static_cast<double>(cycles)) / 100,
            percent(static_cast<double>(activity.item_cycles()), static_cast<double>(cycles)) / 100,
            activity.high_water_mark(), whom(*unit));
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    text += "\nbottleneck: " + bottleneck_text(simulation) + "\n";
    return text;
}

std::string queue_levels_csv(const LevelHistory& history) {
    std::string text = "first_cycle,highest_level\n";
    for (std::size_t k = 0; k < history.highest().size(); ++k)
        text += fmt::format("{},{}\n", k * history.stretch(), history.highest()[k]);
    return text;
}

}  // namespace tessera
