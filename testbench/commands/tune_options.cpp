#include "testbench/commands/tune_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>

#include "testbench/commands/option_values.h"
#include "testbench/setup/height_tests/height_test_host.h"

namespace tessera {

namespace {

/// Checks the text, since the conversion would turn a number beyond 64 bits into another one.
std::string triangles_complaint(const std::string& text) {
    if (text.rfind('-', 0) == 0)
        return text + " is negative";
    errno = 0;
    static_cast<void>(std::strtoull(text.c_str(), nullptr, 10));
    return errno == ERANGE
               ? fmt::format("{}: at most {}, and limits.triangles, can be tuned for", text, most_tuned_triangles)
               : std::string{};
}

}  // namespace

void TuneOptions::add_to(CLI::App& tune) {
    job_given_ = tune.add_option("JOB", order_.job_file, "job file (TOML); default: the half donut");
    triangles_given_ =
        tune.add_option("--triangles", order_.triangles, "find the least error with at most this many triangles")
            ->check(triangles_complaint);
    error_given_ = tune.add_option("--error", order_.error,
                                   "find the fewest triangles with at most this error: units of the map's file on "
                                   "a height field, else model units");
    tune.add_option("--metric", metric_, "error to use: rms or max");
    tune.add_option(
            "--tests", order_.tests,
            fmt::format(
                "thresholds to search: normal, {}, view; rank: that of a Rank Test, with --metric max that of a "
                "Bound Test; with both, the better is used; default: those of the tests that the job enables",
                fmt::join(searched_height_tests(), " or ")))
        ->delimiter(',')
        ->allow_extra_args(false);
    vary_given_ = tune.add_option("--vary", vary_,
                                  "what else to search: unit (tests.summed_height_unit), generation "
                                  "(tests.generation_limit), triangulation, or none; default: all three")
                      ->delimiter(',')
                      ->allow_extra_args(false);
    tune.add_option("--grid", order_.grids,
                    "base meshes to try, for a plane: COLUMNSxROWS, latticeSPACING (vertices at texel centres, "
                    "SPACING texels apart, written as OBJ), or auto; default: the job's own")
        ->delimiter(',')
        ->allow_extra_args(false);
    tune.add_option("--output", order_.output, "the tuned job; its figures beside it as .json, a lattice as .obj");
    tune.add_option("--tried", order_.tried, "CSV file listing all meshes tried");
    tune.add_option("--jobs", order_.jobs, "threads; the result does not depend on them")
        ->check(CLI::Range(1u, most_jobs));
    tune.add_option("--set", order_.settings, "set one key of the job first")->take_all()->allow_extra_args(false);
}

TuneOrder TuneOptions::order() const {
    TuneOrder order = order_;
    if (job_given_->count() > 0 && order.job_file.empty())
        refuse_usage("tune", "JOB is empty: name a job file, or leave it out for the default job");
    if ((triangles_given_->count() > 0) == (error_given_->count() > 0))
        refuse_usage("tune", "give a goal: either --triangles N or --error E");
    if (triangles_given_->count() > 0 && order.triangles == 0)
        refuse_usage("tune", "--triangles 0: a mesh has at least one");
    if (error_given_->count() > 0 && !(order.error > 0 && std::isfinite(order.error)))
        refuse_usage("tune", fmt::format("--error {}: must be above 0", order.error));
    if (metric_ != "rms" && metric_ != "max")
        refuse_usage("tune", fmt::format("--metric {}: must be rms or max", metric_));
    order.largest = metric_ == "max";
    std::vector<std::string_view> known = searched_height_tests();
    known.insert(known.end(), {"normal", "view", "rank"});
    for (const std::string& test : order.tests)
        if (std::find(known.begin(), known.end(), test) == known.end())
            refuse_usage("tune", fmt::format("--tests {}: choose from {}", test, fmt::join(known, ", ")));
    if (vary_given_->count() > 0) {
        order.vary.summed_height_unit = order.vary.generation_limit = order.vary.triangulation = false;
        for (const std::string& choice : vary_) {
            if (choice == "unit")
                order.vary.summed_height_unit = true;
            else if (choice == "generation")
                order.vary.generation_limit = true;
            else if (choice == "triangulation")
                order.vary.triangulation = true;
            else if (choice != "none" || vary_.size() > 1)
                refuse_usage("tune",
                             fmt::format("--vary {}: must be unit, generation or triangulation, or only none", choice));
        }
    }
    if (order.output.empty())
        refuse_usage("tune", "--output is empty: name the tuned job's file");
    return order;
}

}  // namespace tessera
