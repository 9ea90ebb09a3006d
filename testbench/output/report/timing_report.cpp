#include "testbench/output/report/timing_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "modules/units/family/sequence_tests.h"
#include "testbench/output/report/ratio.h"

namespace tessera {

namespace {

constexpr std::size_t most_named = 4;  // units named in a limit

double state_percent(const Unit& unit, State state, std::uint64_t cycles) {
    return 100 * ratio(unit.activity().cycles_in(state), cycles);
}

bool is_memory(const Unit& unit) {
    return dynamic_cast<const MemoryServer*>(&unit) != nullptr;
}

/// The largest share of a state that has a cause: the unit that blocks, is awaited or is missing.
const Activity::Share* largest_share(const Unit& unit, State state) {
    const Activity::Share* largest = nullptr;
    for (const Activity::Share& share : unit.activity().shares())
        if (share.by != nullptr && share.state == state && (largest == nullptr || share.cycles > largest->cycles))
            largest = &share;
    return largest;
}

}  // namespace

std::string unit_name(const sc_core::sc_object& unit) {
    const std::string name = unit.name();
    constexpr std::string_view first_machine = "tessera.";
    return name.rfind(first_machine, 0) == 0 ? name.substr(first_machine.size()) : name;
}

double utilisation(const Unit& unit, std::uint64_t cycles) {
    // The last item's interval may reach beyond the run's end.
    return ratio(std::min(unit.occupied_cycles(), cycles), cycles);
}

bool is_queue_or_join(const Unit& unit) {
    return dynamic_cast<const TriangleQueue*>(&unit) != nullptr ||
           dynamic_cast<const CollectingUnit*>(&unit) != nullptr;
}

std::string Limit::names() const {
    if (units.size() > most_named)
        return fmt::format("{} and {} others", unit_name(*units[0]), units.size() - 1);
    std::string text;
    for (std::size_t k = 0; k < units.size(); ++k)
        text += (k == 0 ? "" : k + 1 == units.size() ? " and " : ", ") + unit_name(*units[k]);
    return text;
}

double Bottleneck::bound() const {
    const double remaining = binding ? next.utilisation : first.utilisation;
    return remaining > 0 ? 1 / remaining : 0;
}

namespace {

/// The off-chip memory, or a table behind a cache, whose utilisation is that of the channel.
bool uses_off_chip_channel(const Machine& machine, const Unit& unit) {
    const std::string cache = std::string(unit.basename()) + "_cache";
    return &unit == &machine.off_chip_memory ||
           std::any_of(machine.caches().begin(), machine.caches().end(),
                       [&](const TableCache* its) { return its->basename() == cache; });
}

}  // namespace

Bottleneck find_bottleneck(const Machine& machine, std::uint64_t cycles) {
    std::vector<const Unit*> left;
    for (const Unit* unit : machine.units())
        if (utilisation(*unit, cycles) > 0)
            left.push_back(unit);
    const auto take_highest = [&] {
        Limit limit;
        for (const Unit* unit : left)
            limit.utilisation = std::max(limit.utilisation, utilisation(*unit, cycles));
        const auto ties = [&](const Unit* unit) { return utilisation(*unit, cycles) >= 0.99 * limit.utilisation; };
        std::copy_if(left.begin(), left.end(), std::back_inserter(limit.units), ties);
        left.erase(std::remove_if(left.begin(), left.end(), ties), left.end());
        return limit;
    };
    Bottleneck found;
    found.first = take_highest();
    const auto on_the_channel = [&](const Unit* unit) { return uses_off_chip_channel(machine, *unit); };
    if (std::any_of(found.first.units.begin(), found.first.units.end(), on_the_channel))
        left.erase(std::remove_if(left.begin(), left.end(), on_the_channel), left.end());
    found.next = take_highest();
    found.binding = found.first.utilisation >= binding_utilisation;
    return found;
}

namespace {

/// The unit that waited longest for a cache, if that is most of the time, and the cache.
std::string wait_for_a_cache(const Machine& machine, std::uint64_t cycles) {
    std::string text;
    std::uint64_t longest = cycles / 2;
    for (const Unit* unit : machine.units()) {
        const Activity::Share* share = largest_share(*unit, State::waiting_for_memory);
        if (share == nullptr || share->cycles <= longest || dynamic_cast<const TableCache*>(share->by) == nullptr)
            continue;
        longest = share->cycles;
        text = fmt::format("{} waits for {} {:.1f} %", unit_name(*unit), share->by->basename(),
                           100 * ratio(longest, cycles));
    }
    return text;
}

/// The unit blocked longest by `by`, and for how many cycles.
std::pair<const Unit*, std::uint64_t> longest_wait(const Machine& machine, const Unit* by) {
    std::pair<const Unit*, std::uint64_t> longest{nullptr, 0};
    for (const Unit* unit : machine.units()) {
        for (const Activity::Share& share : unit->activity().shares())
            if (share.by == by && share.cycles > longest.second)
                longest = {unit, share.cycles};
    }
    return longest;
}

constexpr std::uint64_t most_ports = 64;      // timing.*_ports
constexpr std::size_t most_normal_tests = 9;  // hardware.normal_tests
constexpr double worth_raising = 1.05;        // times faster without the limit
constexpr double least_wait = 1;              // percent of the cycles

std::string off_chip_key(const Machine& machine) {
    const OffChipMemory& memory = machine.off_chip_memory;
    std::uint64_t requests = memory.activity().items_in();
    for (const TableCache* cache : machine.caches())
        requests += cache->fills();
    // Twice the bandwidth saves nothing where a request takes a single cycle.
    return memory.occupied_cycles() >= 2 * requests ? "timing.off_chip_bandwidth" : "";
}

/// The key of which twice the value relieves this unit; empty if there is none that surely does.
std::string relieving_key(const Machine& machine, const Unit& unit) {
    const auto ports = [](std::string table, std::uint64_t all) {
        table.erase(std::min({table.find("_cache"), table.find("_for_tests"), table.size()}));
        return 2 * all <= most_ports ? "timing." + table + "_ports" : "";
    };
    if (uses_off_chip_channel(machine, unit))
        return off_chip_key(machine);
    if (const auto* memory = dynamic_cast<const TableMemory*>(&unit); memory != nullptr)
        return ports(&unit == &machine.height_table ? height_table_spec(machine.registers().formats).name
                                                    : std::string(unit.basename()) + "_for_tests",
                     memory->slots_per_cycle());
    if (dynamic_cast<const TableCache*>(&unit) != nullptr)
        return ports(&unit == machine.height_table_cache.get() ? height_table_spec(machine.registers().formats).name
                                                               : unit.basename(),
                     1);
    const bool shared = !machine.netlist().all<FamilySequenceTests>().empty();
    const std::size_t normal_tests = machine.netlist().all<NormalTest>().size();
    if (shared && 2 * normal_tests <= most_normal_tests && dynamic_cast<const NormalTest*>(&unit) != nullptr)
        return "hardware.normal_tests";
    return "";
}

/// The one key that relieves all units of the limit, if they hold up the others noticeably, and nothing else holds up the
/// unit that waits for them.
std::string relieving_key(const Machine& machine, std::uint64_t cycles, const Bottleneck& found) {
    const auto [waiting, most] = longest_wait(machine, found.first.units[0]);
    const double waits = 100 * ratio(most, cycles);
    if (waiting != nullptr && waits < least_wait)
        return "";
    if (waiting != nullptr && is_memory(*found.first.units[0]) &&
        2 * state_percent(*waiting, State::blocked, cycles) > waits)
        return "";
    std::string key;
    for (const Unit* unit : found.first.units) {
        const std::string its = relieving_key(machine, *unit);
        if (its.empty() || (!key.empty() && its != key))
            return "";
        key = its;
    }
    return found.bound() >= worth_raising ? key : "";
}

/// What a utilisation in per cent says of the unit (modules/README.md, Accounting).
std::string use_text(const Machine& machine, const Unit& unit, double percent) {
    if (uses_off_chip_channel(machine, unit))
        return fmt::format("{:.1f} % of the off-chip channel's cycles are taken", percent);
    const auto* const table = dynamic_cast<const TableMemory*>(&unit);
    if (table != nullptr && table->delays_more_than_it_serves())
        return fmt::format("in {:.1f} % of all cycles a request waits for its ports", percent);
    return fmt::format("{:.1f} % of its {}", percent, is_memory(unit) ? "port slots are taken" : "throughput is used");
}

std::string binding_text(const Machine& machine, std::uint64_t cycles, const Bottleneck& found) {
    const bool several = found.first.units.size() > 1;
    std::string text = found.first.names();
    if (several)
        text += fmt::format(", which tie: {:.1f} % of their throughput is used", 100 * found.first.utilisation);
    else
        text += ": " + use_text(machine, *found.first.units[0], 100 * found.first.utilisation);
    const auto [waiting, most] = longest_wait(machine, found.first.units[0]);
    if (waiting != nullptr)
        text += fmt::format("; {} is delayed by {} in {:.1f} % of all cycles", unit_name(*waiting),
                            several ? unit_name(*found.first.units[0]) : "it", 100 * ratio(most, cycles));
    if (found.bound() > 0)
        text += fmt::format("; without {} at most {:.1f} times faster, bounded by {}, {} {:.1f} %",
                            several ? "them" : "it", found.bound(), found.next.names(),
                            found.next.units.size() > 1 ? "which tie at" : "at", 100 * found.next.utilisation);
    if (const std::string key = relieving_key(machine, cycles, found); !key.empty())
        text += "; a larger " + key + " helps";
    return text;
}

double mean_stay(const Unit& unit) {
    return ratio(unit.activity().item_cycles(), unit.activity().items_out());
}

/// The pipeline stage in which an item stays longest, except those that wait for others by design.
const Unit& longest_stay(const Machine& machine) {
    const Unit* longest = &machine.transform;
    for (const Unit* unit : machine.units()) {
        const bool waits =
            is_queue_or_join(*unit) || unit == &machine.get_triangle || unit == &machine.pass_or_tessellate;
        if (!waits && mean_stay(*unit) > mean_stay(*longest))
            longest = unit;
    }
    return *longest;
}

std::string latency_text(const Machine& machine, std::uint64_t cycles, const Bottleneck& found) {
    const Unit& get = machine.get_triangle;
    const double starved = state_percent(get, State::starved, cycles),
                 blocked = state_percent(get, State::blocked, cycles);
    std::string held_up = wait_for_a_cache(machine, cycles);
    if (held_up.empty())
        held_up = starved > blocked ? fmt::format("get_triangle is starved {:.1f} %", starved)
                                    : fmt::format("get_triangle is blocked {:.1f} %", blocked);
    const Unit& longest = longest_stay(machine);
    return fmt::format(
        "none: bound by latency; of the busiest ({}) {:.1f} % of the throughput is used; at most {:.1f} times faster "
        "with more triangles in flight ({}) or shorter latencies (an item stays {:.1f} cycles in {}){}",
        found.first.names(), 100 * found.first.utilisation, found.bound(), held_up, mean_stay(longest),
        unit_name(longest), machine.off_chip_memory.occupied_cycles() > 0 ? ", and as much off-chip traffic" : "");
}

}  // namespace

std::string bottleneck_text(const Machine& machine, std::uint64_t cycles) {
    const Bottleneck found = find_bottleneck(machine, cycles);
    if (found.first.units.empty())
        return "none: no unit was busy";
    return found.binding ? binding_text(machine, cycles, found) : latency_text(machine, cycles, found);
}

std::string queue_levels_csv(const LevelHistory& history) {
    std::string text = "first_cycle,highest_level\n";
    for (std::size_t k = 0; k < history.highest().size(); ++k)
        text += fmt::format("{},{}\n", k * history.stretch(), history.highest()[k]);
    return text;
}

}  // namespace tessera
