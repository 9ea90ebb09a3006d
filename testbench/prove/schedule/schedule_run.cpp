#include "testbench/prove/schedule/schedule_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <memory>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "modules/timing/all_units.h"
#include "modules/units/pass_or_tessellate.h"
#include "testbench/common/child_process.h"
#include "testbench/common/hash.h"
#include "testbench/machine/simulation.h"
#include "testbench/prove/schedule/machine_plan.h"
#include "testbench/prove/schedule/recorded_units.h"
#include "testbench/prove/schedule/recurrences.h"

namespace tessera {

namespace {

constexpr std::uint64_t most_triangles = 20'000'000, most_cycles_without_progress = 1'000'000;
constexpr unsigned most_seconds = 600;

/// Digests of the cycles in which items entered and left a unit.
class ItemTimes : public ActivityObserver, public schedule::ItemObserver {
  public:
    void item(std::uint64_t cycle, bool came) override {
        std::uint64_t& digest = came ? came_ : left_;
        digest = mix_hash(digest, cycle);
    }
    bool any() const { return came_ != 0; }
    std::string text() const { return fmt::format("{:016x} {:016x}", came_, left_); }

  private:
    std::uint64_t came_ = 0, left_ = 0;
};

/// A machine's units by the schedule's numbers; null: absent, or the rasteriser.
using Units = std::array<Unit*, schedule::units>;

Units units_of(Machine& machine) {
    Units units{};
    for (Unit* const unit : machine.units())
        for (std::size_t k = 0; k < all_units.size(); ++k)
            if (unit->basename() == std::string_view(all_units[k].name))
                units[k] = unit;
    units[schedule::height_test] = &machine.tessellation_tests[0].height_test;
    units[schedule::displacement_map] = &machine.displacement_map;
    units[schedule::displacement_map_for_tests] = machine.displacement_map_for_tests.get();
    units[schedule::normal_map] = &machine.normal_map;
    units[schedule::height_table] = &machine.height_table;
    return units;
}

// The lines of both texts.

template <class CyclesIn>
std::string unit_line(const Unit& unit, std::uint64_t items, const ItemTimes& times, std::uint64_t most,
                      std::uint64_t item_cycles, CyclesIn cycles_in) {
    std::string text = fmt::format("{}: items {} in cycles {}, at most {}, item cycles {}", unit.name(), items,
                                   times.text(), most, item_cycles);
    for (std::size_t state = 0; state < states; ++state)
        text += fmt::format(", {}", cycles_in(static_cast<State>(state)));
    return text;
}

std::string share_text(State state, const char* by, std::uint64_t cycles) {
    return fmt::format(", {} {} {}", static_cast<int>(state), by, cycles);
}

std::string memory_line(const Unit& memory, std::uint64_t entries, std::uint64_t slots, std::uint64_t held_up,
                        std::uint64_t occupied) {
    return fmt::format("{}: {} entries, {} slots, {} cycles held up, {} occupied\n", memory.name(), entries, slots,
                       held_up, occupied);
}

std::string parts_line(std::uint64_t sent, std::uint64_t taken, std::uint64_t corners, std::uint64_t edges,
                       std::uint64_t ahead) {
    return fmt::format("parts {}, {} taken, {} corners, {} edges, {} ahead of parts\n", sent, taken, corners, edges,
                       ahead);
}

std::string levels_line(std::uint64_t most, const LevelHistory& history) {
    std::string text = fmt::format("queue: at most {}, each {} cycles:", most, history.stretch());
    for (const std::uint64_t level : history.highest())
        text += fmt::format(" {}", level);
    return text + "\n";
}

/// Figures of a clocked machine, and of its schedule, in the same form.
class ClockedText {
  public:
    explicit ClockedText(HostedMachine& hosted) : hosted_(hosted), units_(units_of(hosted.machine)) {
        for (std::size_t k = 0; k < units_.size(); ++k)
            if (units_[k] != nullptr)
                units_[k]->activity().observe(&times_[k]);
    }

    std::string text() const {
        const Machine& p = hosted_.machine;
        std::string text = fmt::format("last cycle {}\n", hosted_.last_cycle());
        for (std::size_t k = 0; k < units_.size(); ++k)
            if (units_[k] != nullptr)
                text += unit_text(*units_[k], times_[k]);
        for (const TableMemory* memory :
             {static_cast<const TableMemory*>(&p.displacement_map),
              static_cast<const TableMemory*>(p.displacement_map_for_tests.get()),
              static_cast<const TableMemory*>(&p.normal_map), static_cast<const TableMemory*>(&p.height_table)})
            if (memory != nullptr)
                text += memory_line(*memory, memory->transactions(), memory->slots_taken(), memory->cycles_held_up(),
                                    memory->occupied_cycles());
        const auto& join = p.netlist().the<PassOrTessellate>();
        text += parts_line(p.get_triangle.parts_sent(), join.from_transform.taken(),
                           p.tessellation_tests[0].view_test.from_transform->taken(),
                           join.from_tessellation_tests[0].taken(), p.most_ahead_of_parts());
        return text + levels_line(p.triangle_queue.high_water_mark(), p.triangle_queue.history());
    }

  private:
    static std::string unit_text(const Unit& unit, const ItemTimes& times) {
        const Activity& activity = unit.activity();
        if (times.any() != (activity.items_in() > 0))
            throw std::logic_error(fmt::format("{}: items were not observed", unit.name()));
        std::string text = unit_line(unit, activity.items_in(), times, activity.high_water_mark(),
                                     activity.item_cycles(), [&](State state) { return activity.cycles_in(state); });
        for (const Activity::Share& share : activity.shares())
            if (share.by != nullptr)
                text += share_text(share.state, share.by->name(), share.cycles);
        return text + "\n";
    }

    HostedMachine& hosted_;
    const Units units_;
    std::array<ItemTimes, schedule::units> times_;
};

class ScheduledText {
  public:
    ScheduledText(HostedMachine& hosted, const Design& design)
        : hosted_(hosted),
          units_(units_of(hosted.machine)),
          schedule_(schedule::plan_of(hosted.machine, hosted.rasteriser, design)) {
        for (std::size_t k = 0; k < units_.size(); ++k)
            if (units_[k] != nullptr)
                schedule_.observe(static_cast<schedule::Unit>(k), &times_[k]);
    }

    /// Returns the first pass that the schedule begins in another order; empty: none.
    std::string run(const std::vector<schedule::RecordedPass>& passes) {
        std::vector<std::uint64_t> kept;  // the hash of each child, by place
        schedule_.send(hosted_.host.total());
        for (std::size_t number = 0;; ++number) {
            const schedule::Source::Next& next = schedule_.next();
            if (!next.any)
                return number == passes.size() ? "" : fmt::format("{} of {} passes scheduled", number, passes.size());
            if (number == passes.size())
                return fmt::format("pass {} is scheduled, and was not begun", number);
            const schedule::RecordedPass& pass = passes[number];
            if (next.from_host != pass.is_base() || (!next.from_host && kept.at(next.place) != pass.triangle))
                return fmt::format("pass {}: the schedule begins another triangle", number);
            schedule::Facts facts = pass.facts;
            for (unsigned child = 0; child < facts.children; ++child) {
                facts.place[child] = static_cast<std::uint32_t>(kept.size());
                kept.push_back(pass.children[child]);
            }
            schedule_.pass(facts);
        }
    }

    std::string text(std::uint64_t cycles) {
        schedule_.finish(cycles);
        std::string text = fmt::format("last cycle {}\n", schedule_.last());
        for (std::size_t k = 0; k < units_.size(); ++k)
            if (units_[k] != nullptr)
                text += unit_text(static_cast<schedule::Unit>(k));
        for (const schedule::Unit memory : {schedule::displacement_map, schedule::displacement_map_for_tests,
                                            schedule::normal_map, schedule::height_table}) {
            if (units_[memory] == nullptr)
                continue;
            const schedule::Ports& ports = schedule_.ports(memory);
            const auto& slots = ports.bank_slots();
            text += memory_line(
                *units_[memory], ports.entries(), std::accumulate(slots.begin(), slots.end(), std::uint64_t{0}),
                ports.held_up(),
                std::max(*std::max_element(slots.begin(), slots.end()) / ports.ports_of_a_bank(), ports.held_up()));
        }
        text += parts_line(schedule_.parts_sent(), schedule_.parts_sent(), schedule_.corners(), schedule_.edges(),
                           schedule_.most_ahead_of_parts());
        return text + levels_line(schedule_.source().highest(), schedule_.source().history());
    }

  private:
    std::string unit_text(schedule::Unit unit) const {
        const schedule::Figures its = schedule_.figures(unit);
        std::string text = unit_line(*units_[unit], its.items, times_[unit], its.most, its.item_cycles,
                                     [&](State state) { return its.states->cycles_in(state); });
        for (const schedule::States::Share& share : its.states->shares()) {
            if (share.by == schedule::nobody)
                continue;
            const char* const by =
                share.by == schedule::rasteriser ? hosted_.rasteriser.name() : units_[share.by]->name();
            text += share_text(share.state, by, share.cycles);
        }
        return text + "\n";
    }

    HostedMachine& hosted_;
    const Units units_;
    schedule::Recurrences schedule_;
    std::array<ItemTimes, schedule::units> times_;
};

/// Whether the order of a design's results follows from the order of its items (README.md).
bool has_schedule(const MachineSetup& setup) {
    const Design& design = setup.design;
    const Timing& timing = design.timing;
    const bool cached = timing.displacement_map.cache.bytes > 0 || timing.normal_map.cache.bytes > 0 ||
                        height_table_timing(timing, setup.registers.formats).cache.bytes > 0;
    const bool shared = design.tests_units > 1 || (setup.registers.formats.codes &&
                                                   !displacement_map_has_two_sides(design, setup.registers.formats));
    return design.work == Work::triangle && design.test_order == TestOrder::parallel && design.queue.capacity == 0 &&
           !cached && !shared;
}

/// Observes a machine's clock in every second stretch of some hundred cycles, a hundred times.
class Observer : public sc_core::sc_module, public CycleObserver {
  public:
    Observer(const sc_core::sc_module_name& name, CycleScheduler& clock) : sc_module(name), clock_(clock) {
        SC_HAS_PROCESS(Observer);
        SC_METHOD(begin_stretch);
    }

  private:
    void begin_stretch() {
        clock_.observe(stretches_ % 2 == 1 ? this : nullptr);
        if (++stretches_ < 100)
            next_trigger(clock_.period() * (1 + stretches_ * 97 % 600));
    }
    void begin(std::uint64_t) override {}
    void end_of_cycle(std::uint64_t, std::uint64_t) override {}

    CycleScheduler& clock_;
    unsigned stretches_ = 0;
};

std::string difference(const Job& job, const BaseMesh& mesh, const HeightMap& map, bool observed) {
    const MachineSetup setup = make_setup(job, mesh, map);
    if (!has_schedule(setup))
        return "this design has no schedule";
    schedule::RecordedUnits units;
    Simulation simulation(setup, most_triangles, most_cycles_without_progress, &units);
    std::vector<std::unique_ptr<ClockedText>> clocked;
    std::vector<std::unique_ptr<Observer>> observers;
    for (const auto& hosted : simulation.machines) {
        units.of(hosted->machine.clock).observe(*hosted);
        clocked.push_back(std::make_unique<ClockedText>(*hosted));
        if (observed)
            observers.push_back(
                std::make_unique<Observer>(sc_core::sc_gen_unique_name("observer"), hosted->machine.clock));
    }
    if (std::string stuck = simulation.run(); !stuck.empty())
        return stuck;
    std::size_t passes = 0;
    for (std::size_t k = 0; k < simulation.machines.size(); ++k) {
        HostedMachine& hosted = *simulation.machines[k];
        const std::vector<schedule::RecordedPass> recorded = units.of(hosted.machine.clock).take_passes();
        passes += recorded.size();
        ScheduledText scheduled(hosted, setup.design);
        if (std::string other = scheduled.run(recorded); !other.empty())
            return other;
        if (std::string other = first_difference(clocked[k]->text(), scheduled.text(simulation.cycles()));
            !other.empty())
            return other;
    }
    return passes > 0 ? "" : "no pass was recorded";
}

}  // namespace

std::string schedule_difference(const Job& job, const BaseMesh& mesh, const HeightMap& map, bool observed) {
    const ChildEnd end = run_in_child(
        [&]() -> std::string {
            try {
                return difference(job, mesh, map, observed);
            } catch (const std::exception& error) {
                return error.what();
            }
        },
        most_seconds);
    return end.told + end.failure;
}

std::string first_difference(const std::string& clocked, const std::string& scheduled) {
    std::istringstream left(clocked), right(scheduled);
    std::string a, b;
    while (true) {
        const bool more_left = static_cast<bool>(std::getline(left, a)),
                   more_right = static_cast<bool>(std::getline(right, b));
        if (!more_left && !more_right)
            return {};
        if (more_left != more_right || a != b)
            return fmt::format("clocked:  {}\nschedule: {}", more_left ? a : "", more_right ? b : "");
    }
}

}  // namespace tessera
