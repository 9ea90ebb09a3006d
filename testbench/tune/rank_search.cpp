#include "testbench/tune/rank_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "modules/datapath/rank.h"
#include "testbench/common/error.h"
#include "testbench/job/job_choices.h"
#include "testbench/setup/tables/rank_table.h"

namespace tessera {

namespace {

constexpr std::int64_t usual_bits = 8;
constexpr std::int64_t highest_generation_limit = 15;  // a lattice of 128 texels needs 14

/// Counts a mesh's triangles and, optionally, measures them.
struct Meter {
    struct Note {};

    const TexelError* errors;
    std::uint64_t triangles = 0;
    TexelError::Sum sum;

    Note begin(const datapath::Triangle&) { return {}; }
    void decided(const datapath::TrianglePass&, const datapath::ChildIndices&, const Note&) {}
    Note child(const std::array<std::uint8_t, 3>&) { return {}; }
    void finished(const datapath::Triangle& triangle, bool) {
        ++triangles;
        if (errors != nullptr)
            sum.add(errors->of({&triangle.vertices[0], &triangle.vertices[1], &triangle.vertices[2]}, triangle.base));
    }
};

double six_digits(double value) {
    return std::stod(fmt::format("{:.6g}", value));
}

}  // namespace

void RankSearch::refuse_view(const Job& job) {
    if (job.tests.rank_view != RankView::none)
        throw InputError(fmt::format(
            "tests.rank_view = \"{}\": thresholds in pixels are not searched; use --set tests.rank_view=none",
            name_of(job.tests.rank_view)));
}

Job RankSearch::job_for(const Job& job, const TuneGoal& goal) {
    Job result = job;
    Job::Formats& formats = result.formats;
    const std::int64_t bits = std::max(goal.largest ? formats.bound_bits : formats.rank_bits, usual_bits);
    formats.rank_bits = goal.largest ? 0 : bits;
    formats.bound_bits = goal.largest ? bits : 0;
    result.hardware.height_test = HeightTest::rank;
    result.hardware.triangulation = Triangulation::greatest_rank;
    result.tests.summed_height = true;
    result.tests.normal = false;
    result.tests.generation_limit = highest_generation_limit;
    return result;
}

RankSearch::RankSearch(MachineSetup& setup, const Job& job, const TexelError& errors, const TuneGoal& goal)
    : setup_(setup),
      job_(job),
      errors_(errors),
      goal_(goal),
      datapath_(setup),
      bits_(goal.largest ? setup.registers.formats.bound_bits : setup.registers.formats.rank_bits),
      highest_((std::uint32_t{1} << bits_) - 1) {
    if (goal.largest)
        highest_ = std::min(setup.rank_tables.highest_bound_threshold,
                            bound_threshold(static_cast<double>(setup.map.highest_code()), bits_));
}

double RankSearch::threshold_of(std::uint32_t threshold) const {
    const auto error = [&](std::uint32_t entry) {
        return goal_.largest ? bound_error(entry, bits_) : rank_error(entry, bits_);
    };
    const double codes = std::sqrt(error(threshold) * error(threshold + 1));
    const double rounding = goal_.largest ? setup_.map.rounding : 0;  // part of the threshold, not of its register
    const double value = six_digits((codes + rounding) / static_cast<double>(setup_.map.highest_code()));
    return goal_.largest ? std::min(value, 1.0) : value;
}

Outcome RankSearch::outcome(std::uint32_t threshold, std::uint64_t limit, bool measured) {
    setup_.registers.tests.height_thresholds[goal_.largest ? datapath::bound_number : datapath::rank_number] =
        threshold;
    Meter meter{measured ? &errors_ : nullptr, 0, {}};
    const std::uint64_t most_edges = 6 * limit + 1;  // each triangle is tested once, then bisected or finished
    Outcome result;
    result.complete = datapath_.walk(meter, most_edges) < most_edges && meter.triangles <= limit;
    result.triangles = meter.triangles;
    result.rms = meter.sum.weight > 0 ? std::sqrt(meter.sum.squares / meter.sum.weight) : 0;
    result.max = meter.sum.max;
    ++found_.evaluations;
    return result;
}

bool RankSearch::met(const Outcome& outcome) {
    if (goal_.triangles == 0 && outcome.complete &&
        (!found_.least_error || goal_.error_of(outcome) < goal_.error_of(*found_.least_error)))
        found_.least_error = outcome;
    return goal_.met(outcome);
}

void RankSearch::take(std::uint32_t threshold, const Outcome& outcome) {
    ThresholdSearch::Candidate candidate;
    candidate.point.tests = job_.tests;
    (goal_.largest ? candidate.point.tests.threshold("bound_threshold")
                   : candidate.point.tests.threshold("rank_threshold")) = threshold_of(threshold);
    candidate.point.triangulation = Triangulation::greatest_rank;
    candidate.point.outcome = outcome;
    found_.tried.push_back(candidate);
    if (!found_.best || better(candidate.point, found_.best->point, goal_))
        found_.best = candidate;
}

/// too_high: the least threshold known to give too few triangles for the error or, with a budget, few enough.
void RankSearch::bisect(std::uint32_t too_high) {
    const bool budget = goal_.triangles > 0;
    std::int64_t low = -1, high = too_high;  // budget: too many triangles, few enough; error: met, missed
    while (high - low > 1) {
        const std::int64_t middle = (low + high) / 2;
        const auto threshold = static_cast<std::uint32_t>(middle);
        const Outcome here = outcome(threshold, goal_.limit(), !budget);
        const bool good = met(here);
        if (good && !budget)
            take(threshold, here);
        // A mesh beyond the search's limit is not measured, but has a smaller error.
        const bool lower = budget ? here.complete : here.complete && !good;
        (lower ? high : low) = middle;
    }
    if (budget && high <= highest_) {
        const auto threshold = static_cast<std::uint32_t>(high);
        take(threshold, outcome(threshold, goal_.limit(), true));
    }
}

ThresholdSearch::Found RankSearch::search() {
    if (goal_.triangles > 0) {
        if (outcome(highest_, goal_.limit(), false).complete)
            bisect(highest_);
        return found_;
    }
    std::uint32_t too_high = highest_ + 1;
    if (goal_.largest && setup_.height_per_code != 0) {
        const double codes = goal_.error * setup_.scale / std::abs(setup_.height_per_code);
        const std::uint32_t threshold =
            std::min(bound_threshold(std::max(0.0, codes - setup_.map.rounding), bits_), highest_);
        const Outcome here = outcome(threshold, goal_.limit(), true);
        if (met(here)) {
            take(threshold, here);
            return found_;
        }
        too_high = threshold;
    }
    bisect(too_high);
    return found_;
}

}  // namespace tessera
