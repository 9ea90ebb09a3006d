#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "modules/timing/all_units.h"
#include "testbench/check/transport/conservation.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/tests/machine/mesh_keys.h"
#include "testbench/tests/support/job_setup.h"

/// Requirements on every timed run, for any job and timing.
namespace tessera::testing {

inline Job timed_job() {
    Job job;
    job.mode = Mode::timed;
    return job;
}

/// A plane on which every edge of every triangle splits until the generation limit: each base triangle gives 4, 16, 64
/// ... triangles. Passes: base * (4^(limit + 1) - 1) / 3, none for normals only.
inline Job full_split_job(int side, int limit) {
    Job job = timed_job();
    job.mesh.columns = job.mesh.rows = side;
    job.map.source = MapSource::noise;
    job.tests.normal_threshold = 0;
    job.tests.threshold("summed_height_threshold") = 0;
    job.tests.view_threshold = 0;
    job.tests.generation_limit = limit;
    return job;
}

/// A plane of one quad over a constant map, on which no edge splits.
inline Job one_quad_job() {
    Job job = timed_job();
    job.mesh.columns = job.mesh.rows = 1;
    job.map.source = MapSource::constant;
    return job;
}

/// Its first triangle alone.
inline MachineSetup one_triangle(const Job& job = one_quad_job()) {
    MachineSetup setup = setup_of(job);
    setup.base_triangles.resize(1);
    return setup;
}

/// A unit's four states add up to the run's cycles, and the cycles blocked by each unit to its blocked cycles.
inline void require_cycles_add_up(const Unit& unit, std::uint64_t cycles) {
    INFO(unit.name());
    const Activity& activity = unit.activity();
    std::uint64_t sum = 0;
    for (std::size_t state = 0; state < states; ++state) {
        const std::uint64_t in_state = activity.cycles_in(static_cast<State>(state));
        std::uint64_t named = 0;
        for (const Activity::Share& share : activity.shares())
            if (share.by != nullptr && share.state == static_cast<State>(state))
                named += share.cycles;
        sum += in_state;
        CAPTURE(state);
        CHECK(named <= in_state);
        if (static_cast<State>(state) == State::blocked)
            CHECK(named == in_state);
    }
    CHECK(sum == cycles);
    CHECK(activity.item_cycles() <= activity.high_water_mark() * cycles);
}

/// The longest interval of a unit; the last item's may extend beyond the run's end.
inline std::uint64_t longest_interval(const Timing& t) {
    std::uint64_t longest = 1;
    for (const UnitSpec& unit : all_units)
        if (unit.timing != nullptr)
            longest = std::max<std::uint64_t>(longest, (t.*unit.timing).interval);
    return longest;
}

inline void require_empty(const Unit& unit) {
    INFO(unit.name());
    CHECK(unit.activity().items_in() == unit.activity().items_out());
    CHECK(unit.activity().level() == 0);
    CHECK(unit.describe_contents().empty());
}

/// Each unit receives as many items as another sends.
inline void require_conservation(const Simulation& simulation) {
    for (const Conservation& equation : conservation(simulation)) {
        INFO(equation.name);
        CHECK(equation.left == equation.right);
    }
}

/// Adds the units that a triangle's parts reach, from this one on, before they are joined or tested.
inline void follow_parts(const Machine& p, const sc_core::sc_object& unit, std::set<std::string>& units) {
    if (dynamic_cast<const JoiningUnit*>(&unit) != nullptr || unit.get_parent_object() != &p)
        return;
    units.insert(unit.basename());
    for_each_output(dynamic_cast<const sc_core::sc_module&>(unit), [&](const auto& output) {
        if (output.input() != nullptr)
            follow_parts(p, *output.input()->get_parent_object(), units);
    });
}

/// The bound streams lead a triangle's parts through the units that the list of units says, over which
/// triangles_ahead_of_parts sums.
inline void require_listed_geometry(const Machine& p) {
    std::set<std::string> bound, listed;
    follow_parts(p, *p.get_triangle.to_calculate_new_p.input()->get_parent_object(), bound);
    for (const UnitSpec& unit : all_units)
        if (unit.place == Place::geometry)
            listed.insert(unit.name);
    CHECK(bound == listed);
}

/// The items that Tessellation and the height test of a timed machine receive.
inline void require_timed_conservation(const Simulation& simulation, const HostedMachine& hosted) {
    const Machine& p = hosted.machine;
    require_listed_geometry(p);
    const auto& made = p.tessellation.made_into();
    const std::uint64_t untested = simulation.setup.design.work == Work::family ? p.get_triangle.host_triangles() : 0;
    CHECK(p.tessellation.activity().items_in() == untested + made[1] + made[2] + made[3] + made[4]);
    const Decisions::Evaluated& evaluated = hosted.decisions.evaluated();
    const datapath::Registers& registers = simulation.setup.registers;
    const datapath::HeightTestFunctions& height_test = functions_of(registers.formats.height_test);
    const std::uint64_t requests =
        height_test.requests * (evaluated.summed_height - evaluated.summed_height_by_codes - evaluated.off_lattice);
    if (!height_test.rectangles)
        CHECK(p.height_table_reads() == (registers.tests.summed_height_test ? requests : 0));
    else if (registers.tests.summed_height_test)
        CHECK(p.height_table_reads() >= 4 * requests);
}

inline void require_timed_identities(const Simulation& simulation, const HostedMachine& hosted) {
    require_timed_conservation(simulation, hosted);
    const Machine& p = hosted.machine;
    for (const Unit* unit : p.units()) {
        require_cycles_add_up(*unit, simulation.cycles());
        require_empty(*unit);
        INFO(unit->name());
        CHECK(unit->occupied_cycles() < simulation.cycles() + longest_interval(simulation.setup.design.timing));
    }
    CHECK(hosted.drained());
    CHECK(p.clock.idle());
    CHECK_FALSE(p.clock.stalled());
    CHECK(p.passes_under_way() == 0);
    CHECK(p.triangle_queue.waiting() == 0);
    const std::size_t most = p.triangle_queue.high_water_mark(), on_chip = p.triangle_queue.on_chip_high_water_mark();
    CHECK((p.triangle_queue.spilled() == 0 ? on_chip == most : on_chip <= most));
    const std::size_t capacity = simulation.setup.design.queue.capacity;
    if (capacity != 0)
        CHECK(on_chip <= capacity + register_stages(simulation.setup.design.timing.triangle_queue));
    CHECK(p.pass_or_tessellate.most_incomplete() <= simulation.setup.design.timing.pass_or_tessellate.buffer);
    const std::uint64_t slots = p.height_table.slots_taken();
    CHECK(slots <= simulation.cycles() * p.height_table.slots_per_cycle());
}

/// Call after a timed run that drained.
inline void require_timed_identities(const Simulation& simulation) {
    require_conservation(simulation);
    for (const auto& hosted : simulation.machines)
        require_timed_identities(simulation, *hosted);
}

/// Runs the simulation to its end and checks all of the above.
inline void run_timed(Simulation& simulation) {
    const std::string stuck = simulation.run();
    INFO(stuck);
    REQUIRE(stuck.empty());
    require_timed_identities(simulation);
}

struct KeptSetup {
    MachineSetup kept;
};

/// A simulation that has run to its end with these checks. It keeps its setup.
struct TimedRun : private KeptSetup, Simulation {
    explicit TimedRun(MachineSetup its_setup, std::uint64_t cycles_without_progress = 0)
        : KeptSetup{std::move(its_setup)}, Simulation(kept, 1'000'000, cycles_without_progress) {
        run_timed(*this);
    }
};

/// Runs to the end, in either mode.
inline void run_to_the_end(Simulation& simulation) {
    if (simulation.setup.design.transport == Transport::non_blocking) {
        run_timed(simulation);
        return;
    }
    REQUIRE(simulation.run().empty());
    CHECK(simulation.machine.idle());
    require_conservation(simulation);
}

}  // namespace tessera::testing
