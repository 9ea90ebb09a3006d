#include "testbench/check/conformance/difference_advice.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "testbench/job/job_keys.h"

namespace tessera {

namespace {

/// Settings of the default for each format that is narrower. Texture coordinates and heights are rounded in golden's run,
/// too.
std::vector<std::string> wider_formats(const Job& job) {
    std::vector<std::string> wider;
    for (const char* name : {"formats.position_bits", "formats.position_fraction", "formats.normal_bits",
                             "formats.normal_fraction", "formats.screen_bits", "formats.screen_fraction"}) {
        const Key& key = *find_key(name);
        const auto usual = std::get<std::int64_t>(default_of(key));
        if (std::get<std::int64_t>(key.get(job)) < usual)
            wider.push_back(fmt::format("{} = {}", name, usual));
    }
    return wider;
}

double rounded_up(double percent) {
    return std::ceil(10 * percent) / 10;
}

}  // namespace

std::string difference_advice(const Job& job, double flips_percent, const EndToEndResult* golden_run) {
    if (const std::vector<std::string> wider = wider_formats(job); !wider.empty())
        return fmt::format(
            "the mesh or its decisions differ from the golden model's, whose positions and normals are not rounded, and "
            "formats are narrow: set {}",
            fmt::join(wider, " and "));
    if (flips_percent > job.check.allowed_flips)
        return fmt::format(
            "rounding decides more edges than check.allowed_flips = {} allows: raise the threshold of the test that flips "
            "most (report.txt), or set check.allowed_flips = {:.1f}",
            job.check.allowed_flips, rounded_up(flips_percent));
    if (golden_run != nullptr && !golden_run->bound_hit && !golden_run->empty())
        return fmt::format(
            "rounding decides some edges otherwise than in golden's own run, which is much in a mesh of {} triangles: use a "
            "finer mesh or other thresholds, or set check.allowed_triangles = {:.1f}",
            golden_run->hardware_triangles, rounded_up(golden_run->least_allowed()));
    return {};
}

}  // namespace tessera
