#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/read_job.h"
#include "testbench/job/toml_text.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/inputs.h"
#include "testbench/prove/exact_arithmetic/exact_comparison.h"

// Every number of a job at the ends of its range and next to 0: the result is a message or a correct mesh. Numbers
// beyond their ranges: job/test_refusals.cpp.

using namespace tessera;

namespace {

Job small_job() {
    Job job;
    job.mode = Mode::functional;
    job.map.width = job.map.height = 16;
    job.tests.generation_limit = 3;
    return job;
}

/// As they are written in a job.
std::vector<std::string> extremes_of(const Key& key) {
    std::vector<double> values{key.range.low, key.range.high, 0};
    if (key.kind != KeyKind::integer)
        values.insert(values.end(), {-0.0, 5e-324, -5e-324});
    std::vector<std::string> all;
    for (const double value : values) {
        const bool in_range = value >= key.range.low && value <= key.range.high;
        if (!in_range && !(key.range.or_zero && value == 0))
            continue;
        const std::string text =
            key.kind == KeyKind::integer ? std::to_string(static_cast<std::int64_t>(value)) : toml_number(value);
        all.push_back(key.kind == KeyKind::vector ? "[" + text + ", " + text + ", " + text + "]" : text);
    }
    return all;
}

/// Sets up the job and runs it. The result must be a message or a correct mesh.
std::string outcome_of(const Job& job) {
    try {
        validate(job);
        const auto [mesh, map, resolved] = load_inputs(job);
        const MachineSetup setup = make_setup(resolved.job, mesh, map);
        const ExactComparison run = compare_with_exact(setup, ExactModel(resolved.job, mesh, map), 300'000);
        INFO(run.conformance.first_mismatch);
        INFO(run.invariants.first_violation);
        CHECK(run.conformance.mismatches == 0);
        CHECK(run.invariants.passed());
        CHECK(run.triangles == setup.base_triangles.size() + run.edges_split);
        CHECK(std::isfinite(run.position_rms));
    } catch (const InputError& error) {
        CHECK(std::string(error.what()).find('.') != std::string::npos);
        return error.what();
    } catch (const ResourceError& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST_CASE("limits: every number of a job at the ends of its range runs or is refused") {
    std::size_t ran = 0;
    for (const KeyTable& table : job_tables()) {
        if (table.name == "timing")  // affects simulations only: commands/test_limits_of_formats.cpp
            continue;
        for (const Key& key : table.keys) {
            if (key.kind != KeyKind::integer && key.kind != KeyKind::number && key.kind != KeyKind::vector)
                continue;
            for (const std::string& extreme : extremes_of(key)) {
                const std::string setting = key.name + "=" + extreme;
                INFO(setting);
                Job job = small_job();
                // the largest base mesh has thousands of triangles
                if (key.name == "mesh.rows" || key.name == "mesh.columns")
                    job.tests.generation_limit = 1;
                apply_setting(job, setting);
                ran += outcome_of(job).empty() ? 1u : 0u;
            }
        }
    }
    CHECK(ran > 100);
}
