#pragma once
#include <catch2/catch.hpp>
#include <string>

#include "testbench/check/conformance/setup_check.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/simulation.h"
#include "testbench/output/report/conformance_report.h"

namespace tessera::testing {

/// Runs a job as the program does, in functional mode, up to the set-up check.
struct SetupRun {
    explicit SetupRun(const Job& job) : SetupRun(job, load_mesh(job), load_map(job)) {}
    SetupRun(const Job& job, const BaseMesh& its_mesh, const HeightMap& its_map)
        : mesh(its_mesh),
          map(its_map),
          resolved(resolve_job(functional(job), mesh, map).job),
          setup(make_setup(resolved, mesh, map)),
          golden(resolved, mesh, map, setup.model_scale, setup),
          simulation(setup, 1000000) {
        REQUIRE(simulation.run().empty());
    }

    static Job functional(Job job) {
        job.mode = Mode::functional;
        return job;
    }
    SetupResult check() { return check_setup(setup, golden, simulation); }

    /// Checks another set-up against the memories as they are, and requires that `name` is reported as wrong.
    void require_noticed(const MachineSetup& wrong, const std::string& name) {
        const SetupResult result = check_setup(wrong, golden, simulation);
        INFO(name << ": " << result.first_wrong);
        CHECK(result.wrong() > 0);
        CHECK_THAT(result.first_wrong, Catch::Contains(name));
        Checks checks;
        checks.setup = result;
        CHECK_FALSE(checks.passed());
        CHECK_THAT(report_text(checks, {}), Catch::Contains(result.first_wrong) && Catch::Contains("FAILED: setup\n"));
    }

    BaseMesh mesh;
    HeightMap map;
    Job resolved;
    MachineSetup setup;
    GoldenJob golden;
    Simulation simulation;
};

}  // namespace tessera::testing
