#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "testbench/common/error.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/inputs.h"
#include "testbench/prove/exact_arithmetic/exact_comparison.h"
#include "testbench/tests/support/job_settings.h"
#include "testbench/tests/support/refusals.h"

// Every key of a job at the ends of its range, beyond them, and at invalid numbers: the result is a message that names
// the key, or a correct mesh.

using namespace tessera;
using namespace tessera::testing;

namespace {

Job small_job() {
    Job job;
    job.mode = Mode::functional;
    job.map.width = job.map.height = 16;
    job.tests.generation_limit = 3;
    return job;
}

bool in_range(const Key& key, double value) {
    return (value >= key.range.low && value <= key.range.high) || (key.range.or_zero && value == 0);
}

struct Extreme {
    std::string text;
    double value;
};

std::vector<Extreme> extremes_of(const Key& key) {
    std::vector<Extreme> all;
    const double largest = 9223372036854775807.0;
    if (key.kind == KeyKind::integer) {
        const auto low = static_cast<std::int64_t>(key.range.low), high = static_cast<std::int64_t>(key.range.high);
        for (const std::int64_t value :
             {low, high, low - 1, high + 1, std::int64_t{0}, std::int64_t{-1}, std::numeric_limits<std::int64_t>::max(),
              std::numeric_limits<std::int64_t>::min()})
            all.push_back({std::to_string(value), static_cast<double>(value)});
        all.push_back({"9223372036854775808", 2 * largest});  // no 64 bit integer
        return all;
    }
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    const auto add = [&](double value) {
        char text[40];
        std::snprintf(text, sizeof text, "%.17g", value);
        std::string number = text;
        if (number.find_first_of(".en") == std::string::npos)
            number += ".0";
        all.push_back(
            {key.kind == KeyKind::vector ? "[" + number + ", " + number + ", " + number + "]" : number, value});
    };
    const double low = key.range.low, high = key.range.high;
    for (const double value : {low, high, std::nextafter(low, -infinity), std::nextafter(high, infinity), -0.0, 0.0,
                               1e308, -1e308, 5e-324, -5e-324, nan, infinity, -infinity})
        add(value);
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

TEST_CASE("limits: every number of a job, at and beyond its range, is refused by name or runs") {
    std::size_t tried = 0, refused = 0, ran = 0;
    for (const KeyTable& table : job_tables()) {
        for (const Key& key : table.keys) {
            if (key.kind != KeyKind::integer && key.kind != KeyKind::number && key.kind != KeyKind::vector)
                continue;
            for (const Extreme& extreme : extremes_of(key)) {
                const std::string setting = key.name + "=" + extreme.text;
                INFO(setting);
                ++tried;
                Job job = small_job();
                // the largest base mesh has thousands of triangles
                if (key.name == "mesh.rows" || key.name == "mesh.columns")
                    job.tests.generation_limit = 1;
                const std::string message = input_error_of([&] { apply_setting(job, setting); });
                const bool fits = in_range(key, extreme.value);
                CHECK(message.empty() == fits);
                if (!fits) {
                    ++refused;
                    CHECK_THAT(message, Catch::Contains(key.name));
                    continue;
                }
                // timing affects simulations only: test_limits.cpp
                if (table.name == "timing")
                    continue;
                ran += outcome_of(job).empty() ? 1u : 0u;
            }
        }
    }
    CHECK(tried > 900);
    CHECK(refused > 500);
    CHECK(ran > 100);
}

TEST_CASE("limits: cameras without a valid view are refused with the names of both keys") {
    expect_refusals(
        {
            {"camera.eye=[1,2,3] camera.target=[1,2,3]", {"`camera.eye`", "`camera.target`", "same point"}},
            {"camera.eye=[1e6,1e6,1e6] camera.target=[1e6,1e6,999999.9999999]", {"same point"}},
            {"camera.eye=[0,0,3] camera.target=[0,0,0] camera.up=[0,0,1]", {"`camera.up`", "parallel"}},
            {"camera.eye=[0,0,3] camera.target=[0,0,0] camera.up=[0,0,-5]", {"parallel"}},
            {"camera.up=[0,0,0]", {"`camera.up`", "no direction"}},
            {"hardware.light=[0,0,0]", {"`hardware.light`"}},
        },
        [](const std::string& settings) { return outcome_of(with_settings(small_job(), settings)); });
}
