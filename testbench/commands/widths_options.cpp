#include "testbench/commands/widths_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "testbench/commands/option_values.h"

namespace tessera {

namespace {

constexpr std::int64_t most_bits = 64;

std::pair<std::int64_t, std::int64_t> range_in(const std::string& text) {
    const std::size_t dots = text.find("..");
    const std::int64_t from = parse_number(text.substr(0, dots));
    const std::int64_t to = dots == std::string::npos ? from : parse_number(text.substr(dots + 2));
    if (from < 1 || to < 1)
        refuse_usage(
            "widths",
            fmt::format("--bits {}: expected a range of widths in bits, as in --bits 8..16, or one width", text));
    if (from > to)
        refuse_usage("widths", fmt::format("--bits {}: ends before it begins; write {}..{}", text, to, from));
    if (to > most_bits)
        refuse_usage("widths", fmt::format("--bits {}: no format has more than {} bits", text, most_bits));
    return {from, to};
}

}  // namespace

void WidthsOptions::add_to(CLI::App& widths) {
    job_given_ = widths.add_option("JOB", order_.job_file, "job file (TOML); default: the half donut");
    widths
        .add_option("--quantity", order_.quantities,
                    "sweep only these: position, normal, texture, displacement, summed_height, screen, "
                    "screen_range, generation")
        ->delimiter(',')
        ->allow_extra_args(false);
    bits_given_ =
        widths.add_option("--bits", bits_,
                          "total widths to try, in bits, as in 8..16; default: all widths that the format allows, "
                          "in steps if there are many");
    flips_given_ = widths.add_option("--flips", flips_,
                                     "limit for the knee: percentage of edges whose split decision differs from exact "
                                     "arithmetic; default: 0.5 more than at the widest");
    error_given_ = widths.add_option("--error", error_,
                                     "limit for the knee: RMS error of displaced positions in model units; "
                                     "default: 1.25 times that of the widest");
    widths.add_option("--output", order_.output,
                      "folder for widths.csv and widths.json, or a .csv file, with a .json beside it");
    widths.add_option("--jobs", order_.jobs, "threads; the result does not depend on them")
        ->check(CLI::Range(1u, most_jobs));
    widths.add_option("--set", order_.settings, "set one key of the job first")->take_all()->allow_extra_args(false);
}

WidthsOrder WidthsOptions::order() const {
    WidthsOrder order = order_;
    if (job_given_->count() > 0 && order.job_file.empty())
        refuse_usage("widths", "JOB is empty: name a job file, or leave it out for the default job");
    if (bits_given_->count() > 0)
        order.bits = range_in(bits_);
    if (flips_given_->count() > 0) {
        if (!(flips_ >= 0 && flips_ <= 100))
            refuse_usage("widths", fmt::format("--flips {}: must be 0 to 100 percent", flips_));
        order.most_flips = flips_;
    }
    if (error_given_->count() > 0) {
        if (!(error_ >= 0 && std::isfinite(error_)))
            refuse_usage("widths", fmt::format("--error {}: must be 0 or more", error_));
        order.most_error = error_;
    }
    if (order.output.empty())
        refuse_usage("widths", "--output is empty: name a folder, or a .csv file");
    return order;
}

}  // namespace tessera
