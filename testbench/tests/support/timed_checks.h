#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>

#include "testbench/check/transport/conservation.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/tests/machine/mesh_keys.h"

/// What must hold of every timed run, whatever its job and its timing.
namespace tessera::testing {

inline MachineSetup setup_of(const Job& job) {
    const Inputs inputs = load_inputs(job);
    return make_setup(inputs.resolved.job, inputs.mesh, inputs.map);
}

inline Job timed_job() {
    Job job;
    job.mode = Mode::timed;
    return job;
}

/// A plane on which every edge of every triangle splits until the generation limit: base triangles, 4, 16, 64 ... of
/// each. Passes: base * (4^(limit + 1) - 1) / 3, none for normals only.
inline Job full_split_job(int side, int limit) {
    Job job = timed_job();
    job.mesh.columns = job.mesh.rows = side;
    job.map.source = MapSource::noise;
    job.tests.normal_threshold = 0;
    job.tests.summed_height_threshold = 0;
    job.tests.view_threshold = 0;
    job.tests.generation_limit = limit;
    return job;
}

/// A unit's four states make up the run, and what it was blocked by makes up the cycles it was blocked.
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

inline void require_empty(const Unit& unit) {
    INFO(unit.name());
    CHECK(unit.activity().items_in() == unit.activity().items_out());
    CHECK(unit.activity().level() == 0);
    CHECK(unit.describe_contents().empty());
}

/// Of the Tessellation Tests units, however many: what `figure` says of each, summed.
template <class Figure>
std::uint64_t sum_over_tests(const Pipeline& pipeline, Figure figure) {
    std::uint64_t sum = 0;
    for (const TessellationTests& tests : pipeline.tessellation_tests)
        sum += figure(tests);
    return sum;
}

/// What goes into one unit came out of another.
inline void require_conservation(const Simulation& simulation) {
    for (const Conservation& equation : conservation(simulation)) {
        INFO(equation.name);
        CHECK(equation.left == equation.right);
    }
    const Pipeline& p = simulation.pipeline;
    const auto& made = p.tessellation.made_into();
    CHECK(p.tessellation.activity().items_in() == made[1] + made[2] + made[3] + made[4]);
    if (simulation.setup.registers.tests.summed_height_test)
        CHECK(p.summed_height_table_reads() >= 12 * p.edges_tested());
}

/// To be called after a timed run that drained.
inline void require_timed_identities(const Simulation& simulation) {
    const Pipeline& p = simulation.pipeline;
    for (const Unit* unit : p.units()) {
        require_cycles_add_up(*unit, simulation.cycles());
        require_empty(*unit);
    }
    require_conservation(simulation);
    CHECK(simulation.host.idle());
    CHECK(p.idle());
    CHECK(p.clock.idle());
    CHECK_FALSE(p.clock.stalled());
    CHECK(p.passes_under_way() == 0);
    CHECK(p.triangle_queue.waiting() == 0);
    CHECK(p.triangle_queue.on_chip_high_water_mark() <= p.triangle_queue.high_water_mark());
    const std::size_t capacity = simulation.setup.design.queue.capacity;
    if (capacity != 0)
        CHECK(p.triangle_queue.on_chip_high_water_mark() <= capacity);
    CHECK(p.pass_or_tessellate.most_incomplete() <= simulation.setup.design.timing.pass_or_tessellate.buffer);
    const std::uint64_t slots = p.summed_height_table.slots_taken();
    CHECK(slots <= simulation.cycles() * p.summed_height_table.slots_per_cycle());
}

/// Runs it to its end, and all of the above.
inline void run_timed(Simulation& simulation) {
    const std::string stuck = simulation.run();
    INFO(stuck);
    REQUIRE(stuck.empty());
    require_timed_identities(simulation);
}

}  // namespace tessera::testing
