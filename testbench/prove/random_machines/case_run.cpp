#include "testbench/prove/random_machines/case_run.h"

#include <fmt/core.h>

#include "testbench/check/conformance/scoreboard.h"
#include "testbench/check/conformance/setup_check.h"
#include "testbench/check/mesh/invariants.h"
#include "testbench/check/transport/conservation.h"
#include "testbench/common/hash.h"
#include "testbench/common/random.h"
#include "testbench/machine/totals.h"

namespace tessera {

namespace {

/// Sum of hashes over the triangles: independent of their order.
std::uint64_t digest_of(const EmittedMesh& mesh) {
    std::uint64_t sum = 0;
    for (const EmittedTriangle& triangle : mesh.triangles) {
        std::uint64_t digest = 0;
        for (const auto& corner : triangle.corners)
            digest = mix_hash(mix_hash(digest, hash_of(corner)), corner.generation);
        for (const std::int64_t value : {std::int64_t{triangle.base}, std::int64_t{triangle.split_by},
                                         std::int64_t{triangle.stopped_by}, std::int64_t{triangle.culled}})
            digest = mix_hash(digest, static_cast<std::uint64_t>(value));
        sum += Random(digest).bits();
    }
    return sum;
}

}  // namespace

void CaseFigures::add(const CaseFigures& other) {
    const std::uint64_t own_digest = mesh_digest;
    add_counts(*this, other);
    mesh_digest = own_digest;
}

CaseResult run_case(const RandomCase& random_case, Mode mode) {
    RandomCase with_mode = random_case;
    with_mode.job.mode = mode;
    const BaseMesh base_mesh = with_mode.base_mesh();
    const HeightMap height_map = with_mode.height_map();
    const MachineSetup setup = make_setup(with_mode.job, base_mesh, height_map);
    const GoldenInputs golden(setup);
    Simulation simulation(setup, RandomCase::most_edges,
                          static_cast<std::uint64_t>(with_mode.job.limits.cycles_without_progress));
    Scoreboard scoreboard(setup.registers, golden);
    simulation.observe_decisions(scoreboard);
    TransportCheck transport(setup.registers, setup.base_triangles);
    observe(simulation, transport);

    CaseResult result;
    const auto fail = [&](const std::string& what) { result.failure += (result.failure.empty() ? "" : "\n") + what; };
    if (const std::string stuck = simulation.run(); !stuck.empty())
        fail(stuck);

    const EmittedMesh& mesh = simulation.monitor.mesh;
    const InvariantResult invariants = check_invariants(mesh, setup);
    if (!invariants.passed())
        fail(fmt::format("{} violations of the invariants: {}", invariants.violations(), invariants.first_violation));
    const SetupResult checked_setup =
        check_setup(setup, GoldenJob(with_mode.job, base_mesh, height_map, setup.model_scale, setup), simulation);
    if (!checked_setup.passed())
        fail(fmt::format("set-up: {}", checked_setup.first_wrong));
    const ConformanceResult conformance = scoreboard.result();
    if (conformance.mismatches > 0)
        fail(fmt::format("{} mismatches: {}", conformance.mismatches, conformance.first_mismatch));

    const Totals totals(simulation);
    const std::uint64_t passes = totals.counts.passes;
    if (conformance.edges != totals.counts.edges_tested || 3 * passes != invariants.edges)
        fail(
            fmt::format("the machine tested {} edges in {} passes, the scoreboard received {}, the bare datapath "
                        "evaluates {}",
                        totals.counts.edges_tested, passes, conformance.edges, invariants.edges));
    if (const WorkResult work = work_result(transport, simulation); !work.passed())
        fail(fmt::format("{} violations of the work check: {}", work.violations, work.first_violation));

    CaseFigures& figures = result.figures;
    figures.runs = 1;
    figures.base_triangles = setup.base_triangles.size();
    figures.triangles = mesh.triangles.size();
    figures.edges = conformance.edges;
    figures.cracks = invariants.cracks;
    figures.t_vertices = invariants.t_vertices;
    figures.other_violations = invariants.violations() - invariants.cracks - invariants.t_vertices;
    figures.collapsed = invariants.collapsed;
    figures.turned_over = invariants.turned_over;
    figures.open_input_edges = invariants.open_texture_seam_edges + invariants.open_crease_edges;
    figures.flips = conformance.flipped_edges;
    figures.mismatches = conformance.mismatches;
    figures.spilled = totals.spilled;
    figures.cycles = simulation.cycles();
    figures.mesh_digest = digest_of(mesh);
    return result;
}

}  // namespace tessera
