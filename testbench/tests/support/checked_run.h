#pragma once
#include <utility>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/check/transport/conservation.h"
#include "testbench/machine/totals.h"
#include "testbench/tests/support/timed_checks.h"

namespace tessera::testing {

/// A job that is set up, simulated in its mode to its end, and checked: every decision against the golden model, the
/// mesh for cracks and against the bare recursion, and no item lost or changed. Tests may inspect its figures.
struct CheckedRun {
    explicit CheckedRun(const Job& job) : CheckedRun(setup_of(job)) {}
    explicit CheckedRun(MachineSetup its_setup, UnitFactory* units = nullptr)
        : setup(std::move(its_setup)), simulation(setup, 1'000'000, 1'000'000, units) {
        const GoldenInputs golden(setup);
        Scoreboard scoreboard(setup.registers, golden);
        simulation.observe_decisions(scoreboard);
        observe(simulation, transport);
        run_to_the_end(simulation);
        for (const auto& hosted : simulation.machines) {
            hosted->machine.pass_or_tessellate.decided.unbind(scoreboard);
            hosted->machine.tessellation.inserted.unbind(scoreboard);
        }
        const Totals totals(simulation);
        counts = totals.counts;

        conformance = scoreboard.result();
        CHECK(conformance.quantities.front().count >= 3 * counts.edges_split);  // P_ij of each inserted vertex
        INFO(conformance.first_mismatch);
        CHECK(conformance.mismatches == 0);
        CHECK(conformance.edges == counts.edges_tested);
        const WorkResult work = work_result(transport, simulation);
        INFO(work.first_violation);
        CHECK(work.passed());
        invariants = check_invariants(mesh, setup);
        INFO(invariants.first_violation);
        CHECK(invariants.passed());
        CHECK(invariants.edges == 3 * counts.passes);
        CHECK(counts.finished == mesh.triangles.size());
        CHECK(counts.finished == setup.base_triangles.size() + counts.edges_split);
        CHECK(totals.lit + counts.culled == counts.finished);
    }

    /// Requires no triangle without area, none turned over, and no open texture seam.
    void expect_closed_in_texture() const {
        CHECK(invariants.collapsed == 0);
        CHECK(invariants.turned_over == 0);
        CHECK(invariants.open_texture_seam_edges == 0);
    }

    const MachineSetup setup;
    TransportCheck transport{setup.registers, setup.base_triangles};
    Simulation simulation;
    const Machine& machine = simulation.machine;
    const EmittedMesh& mesh = simulation.monitor.mesh;
    DecidingUnit::Counts counts;  // of all machines
    ConformanceResult conformance;
    InvariantResult invariants;
};

}  // namespace tessera::testing
