#include "testbench/tune/threshold_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "testbench/setup/height_tests/height_test_host.h"
#include "testbench/setup/thresholds.h"
#include "testbench/tune/threshold_level.h"

namespace tessera {

namespace {

constexpr int octave = levels_per_octave;
constexpr int widest_ratio = 4 * octave;
constexpr std::size_t most_polished = 6;
constexpr int most_moves = 20;
constexpr double swept_triangles = 1e7;  // total over all meshes of a sweep
constexpr double fewest_swept = 400, most_swept = 10000;

datapath::Triangulation machine_name(Triangulation triangulation) {
    return triangulation == Triangulation::first    ? datapath::Triangulation::first
           : triangulation == Triangulation::second ? datapath::Triangulation::second
                                                    : datapath::Triangulation::shorter;
}

}  // namespace

bool better(const TunedPoint& a, const TunedPoint& b, const TuneGoal& goal) {
    const double error_a = goal.error_of(a.outcome), error_b = goal.error_of(b.outcome);
    if (goal.triangles > 0)
        return error_a != error_b ? error_a < error_b : a.outcome.triangles < b.outcome.triangles;
    return a.outcome.triangles != b.outcome.triangles ? a.outcome.triangles < b.outcome.triangles : error_a < error_b;
}

ThresholdSearch::ThresholdSearch(RefinementForest& forest, const MachineSetup& setup, const Job& job,
                                 const TuneGoal& goal, const TuneSpace& space, std::function<void(double)> on_progress)
    : forest_(forest),
      setup_(setup),
      job_(job),
      goal_(goal),
      space_(space),
      on_progress_(std::move(on_progress)),
      height_test_(job.hardware.height_test),
      height_threshold_(host_of(height_test_).searched()) {}

// A threshold below its register's first step becomes 0; one above all possible values lets nothing pass.

ThresholdSearch::Levels ThresholdSearch::normal_levels() const {
    return {level_of(std::ldexp(1.0, -setup_.registers.formats.normal.fraction)) - 1, octave};
}

ThresholdSearch::Levels ThresholdSearch::summed_height_levels(SummedHeightUnit unit) const {
    const HeightTestHost::Range range = searched_range(height_test_, setup_, unit);
    return {level_of(range.finest) - 1, level_of(range.coarsest)};
}

ThresholdSearch::Levels ThresholdSearch::view_levels() const {
    return {level_of(std::ldexp(1.0, -setup_.registers.formats.screen.fraction)) - 1,
            level_of(static_cast<double>(job_.camera.viewport_width + job_.camera.viewport_height))};
}

ThresholdSearch::Key ThresholdSearch::key_of(const Shape& shape) {
    return {shape.unit, shape.triangulation, shape.generation_limit, shape.view, shape.ratio};
}

ThresholdSearch::Shape ThresholdSearch::first_shape() const {
    Shape shape;
    shape.unit = job_.tests.summed_height_unit;
    shape.triangulation = job_.hardware.triangulation;
    shape.generation_limit = job_.tests.generation_limit;
    return shape;
}

Job::Tests ThresholdSearch::tests_at(const Shape& shape, const Place& place) const {
    const auto threshold = [](int level, const Levels& levels) {
        return level <= levels.finest ? 0 : threshold_at(std::min(level, levels.coarsest));
    };
    Job::Tests tests = job_.tests;
    tests.summed_height_unit = shape.unit;
    tests.generation_limit = shape.generation_limit;
    if (shape.ratio == normal_alone)
        tests.summed_height = false;
    else if (space_.summed_height)
        tests.threshold(height_threshold_) = threshold(place.summed_height, summed_height_levels(shape.unit));
    if (shape.ratio == summed_height_alone)
        tests.normal = false;
    else if (space_.normal)
        tests.normal_threshold = threshold(place.normal, normal_levels());
    if (space_.view)
        tests.view_threshold = threshold(place.view, view_levels());
    return tests;
}

datapath::TestParameters ThresholdSearch::registers_of(const Job::Tests& tests) const {
    return make_tests(tests, setup_.registers.formats);
}

datapath::TestParameters ThresholdSearch::finest() const {
    Job::Tests tests = job_.tests;
    if (space_.normal)
        tests.normal_threshold = 0;
    if (space_.summed_height)
        tests.threshold(height_threshold_) = 0;
    if (space_.view)
        tests.view_threshold = 0;
    return registers_of(tests);
}

/// The mesh exceeds the budget, or its error is within the bound, so that fewer triangles may do.
bool ThresholdSearch::too_fine(const Shape& shape, const Place& place) {
    if (goal_.triangles == 0)
        return goal_.met(measured(shape, place).point.outcome);
    ++found_.evaluations;
    return !forest_.count(registers_of(tests_at(shape, place)), machine_name(shape.triangulation), goal_.triangles)
                .complete;
}

/// The finest level within the budget. low < high are widened until they enclose it.
std::optional<int> ThresholdSearch::bisect(const Levels& levels, int low, int high, const Shape& shape,
                                           const PlaceAt& at) {
    low = std::clamp(low, levels.finest, levels.coarsest);
    high = std::clamp(high, low, levels.coarsest);
    while (too_fine(shape, at(high))) {
        if (high == levels.coarsest)
            return std::nullopt;
        low = high;
        high = std::min(levels.coarsest, high + octave);
    }
    while (low >= high || !too_fine(shape, at(low))) {
        if (low == levels.finest)
            return low;
        high = std::min(low, high);
        low = std::max(levels.finest, low - octave);
    }
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        (too_fine(shape, at(middle)) ? low : high) = middle;
    }
    return high;
}

/// The coarsest level within the error bound, except for islands narrower than a quarter of an octave.
std::optional<int> ThresholdSearch::descend(const Levels& levels, int high, const Shape& shape, const PlaceAt& at) {
    high = std::clamp(high, levels.finest, levels.coarsest);
    while (high < levels.coarsest && too_fine(shape, at(high)))
        high = std::min(levels.coarsest, high + octave);
    int low = high;
    while (!too_fine(shape, at(low))) {
        if (low == levels.finest)
            return std::nullopt;
        high = low;
        low = std::max(levels.finest, low - octave / 4);
    }
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        (too_fine(shape, at(middle)) ? low : high) = middle;
    }
    return low;
}

std::optional<int> ThresholdSearch::just_met(const Levels& levels, int low, int high, const Shape& shape,
                                             const PlaceAt& at) {
    return goal_.triangles > 0 ? bisect(levels, low, high, shape, at) : descend(levels, high, shape, at);
}

/// The level of one test's threshold that meets the goal with the other test off.
std::optional<int> ThresholdSearch::alone(const Shape& shape, int which) {
    Shape one = shape;
    one.ratio = which;
    const auto known = alone_.find(key_of(one));
    if (known != alone_.end())
        return known->second;
    const bool normal = which == normal_alone;
    const Levels levels = normal ? normal_levels() : summed_height_levels(shape.unit);
    const std::optional<int> level = just_met(levels, levels.coarsest, levels.coarsest, one, [&](int candidate) {
        return Place{candidate, candidate, shape.view};
    });
    alone_.emplace(key_of(one), level);
    return level;
}

std::optional<ThresholdSearch::Place> ThresholdSearch::solve(const Shape& shape) {
    const auto placed = [&](const std::optional<int>& level, const PlaceAt& at) {
        return level ? std::optional<Place>(at(*level)) : std::nullopt;
    };
    const Levels normal = normal_levels(), summed = summed_height_levels(shape.unit);
    if (!space_.normal || !space_.summed_height) {
        const bool view_only = !space_.normal && !space_.summed_height;
        const Levels levels = space_.normal ? normal : (space_.summed_height ? summed : view_levels());
        const PlaceAt at = [&](int level) { return Place{level, level, view_only ? level : shape.view}; };
        return placed(just_met(levels, levels.coarsest, levels.coarsest, shape, at), at);
    }
    if (shape.ratio == normal_alone || shape.ratio == summed_height_alone)
        return placed(alone(shape, shape.ratio), [&](int level) { return Place{level, level, shape.view}; });
    const int normal_level = alone(shape, normal_alone).value_or(normal.finest);
    const int summed_level = alone(shape, summed_height_alone).value_or(summed.finest);
    const int half = shape.ratio / 2;
    const Levels levels{std::min(normal.finest - normal_level - half, summed.finest - summed_level + half),
                        std::max(normal.coarsest - normal_level - half, summed.coarsest - summed_level + half)};
    const PlaceAt at = [&](int level) {
        return Place{normal_level + level + half, summed_level + level - half, shape.view};
    };
    return placed(just_met(levels, std::abs(half) - octave / 32, std::abs(half) + octave, shape, at), at);
}

ThresholdSearch::Candidate ThresholdSearch::measured(const Shape& shape, const Place& place) {
    ++found_.evaluations;
    Candidate candidate{{tests_at(shape, place), shape.triangulation, {}}, shape, place};
    Outcome& outcome = candidate.point.outcome;
    outcome = forest_.measure(registers_of(candidate.point.tests), machine_name(shape.triangulation), goal_.limit());
    if (goal_.triangles == 0 && outcome.complete &&
        (!found_.least_error || goal_.error_of(outcome) < goal_.error_of(*found_.least_error)))
        found_.least_error = outcome;
    return candidate;
}

/// Returns whether the candidate is the best so far.
bool ThresholdSearch::take(const Candidate& candidate) {
    if (!goal_.met(candidate.point.outcome) || (found_.best && !better(candidate.point, found_.best->point, goal_)))
        return false;
    found_.best = candidate;
    return true;
}

bool ThresholdSearch::attempt(const Shape& shape) {
    if (!done_.insert(key_of(shape)).second)
        return false;
    const std::optional<Place> place = solve(shape);
    step_done();
    if (!place)
        return false;
    const Candidate candidate = measured(shape, *place);
    if (goal_.met(candidate.point.outcome))
        found_.tried.push_back(candidate);
    return take(candidate);
}

void ThresholdSearch::step_done() {
    ++steps_;
    if (on_progress_)
        on_progress_(std::min(1.0, static_cast<double>(steps_) / expected_steps_));
}

/// The units to search, the job's own first.
std::vector<SummedHeightUnit> ThresholdSearch::units() const {
    const SummedHeightUnit own = job_.tests.summed_height_unit;
    if (!space_.summed_height || !space_.summed_height_unit || height_test_ != HeightTest::summed_height)
        return {own};
    return {own, own == SummedHeightUnit::sum ? SummedHeightUnit::area : SummedHeightUnit::sum};
}

void ThresholdSearch::explore() {
    const std::vector<SummedHeightUnit> units = this->units();
    std::vector<int> ratios{0};
    if (space_.normal && space_.summed_height) {
        ratios = {normal_alone, summed_height_alone};
        for (int ratio = -widest_ratio; ratio <= widest_ratio; ratio += 2 * octave)
            ratios.push_back(ratio);
    }
    steps_ = 0;
    expected_steps_ = static_cast<int>(units.size() * ratios.size()) + 8;
    Shape shape = first_shape();
    for (const SummedHeightUnit unit : units)
        for (const int ratio : ratios) {
            shape.unit = unit;
            shape.ratio = ratio;
            attempt(shape);
        }
    if (!space_.generation_limit || !job_.tests.generation || !found_.best)
        return;
    // Each test alone too: it may perform best at another generation limit than the best so far.
    for (const int ratio : ratios)
        if (ratio == normal_alone || ratio == summed_height_alone) {
            shape = found_.best->shape;
            shape.ratio = ratio;
            try_generation_limits(shape);
        }
    refine_generation_limit();
}

bool ThresholdSearch::refine_triangulation() {
    bool found = false;
    Shape shape = found_.best->shape;
    for (const Triangulation choice : {Triangulation::shorter, Triangulation::first, Triangulation::second}) {
        shape.triangulation = choice;
        found = attempt(shape) || found;
    }
    return found;
}

bool ThresholdSearch::refine_generation_limit() {
    return try_generation_limits(found_.best->shape);
}

bool ThresholdSearch::try_generation_limits(Shape shape) {
    // A limit that no vertex reaches changes nothing.
    const std::int64_t reached = found_.best->point.outcome.generation;
    bool found = false;
    for (std::int64_t limit = std::min(job_.tests.generation_limit, reached + 2); limit > 0; --limit) {
        shape.generation_limit = limit;
        found = attempt(shape) || found;
    }
    return found;
}

bool ThresholdSearch::refine_view() {
    bool found = false;
    Shape shape = found_.best->shape;
    for (shape.view = 0; shape.view < view_levels().coarsest; shape.view += octave)
        found = attempt(shape) || found;
    return found;
}

bool ThresholdSearch::refine_ratio() {
    bool found = false;
    Shape from = found_.best->shape;
    for (from.ratio = -widest_ratio; from.ratio <= widest_ratio; from.ratio += octave)
        found = attempt(from) || found;
    for (int step = octave / 2; step >= octave / 16; step /= 2) {
        const int ratio = found_.best->shape.ratio;
        if (std::abs(ratio) > widest_ratio + octave)
            break;  // one test alone
        for (const int candidate : {ratio - step, ratio + step}) {
            Shape shape = found_.best->shape;
            shape.ratio = candidate;
            found = attempt(shape) || found;
        }
    }
    return found;
}

/// Sweeps a coarse grid of both thresholds, from an octave below the level at which each meets the goal alone: neither
/// counts nor errors are quite regular, and some good points lie on no line of just met goals.
void ThresholdSearch::sweep(SummedHeightUnit unit) {
    Shape shape = found_.best->shape;
    shape.unit = unit;
    const auto lowest = [&](int which, const Levels& levels) {
        const int level = alone(shape, which).value_or(levels.finest);
        return std::max(levels.finest, level - octave);
    };
    const Levels normal = normal_levels(), summed = summed_height_levels(shape.unit);
    const int normal_low = lowest(normal_alone, normal), summed_low = lowest(summed_height_alone, summed);
    const double meshes = std::clamp(swept_triangles / static_cast<double>(std::max<std::uint64_t>(
                                                           goal_.triangles, found_.best->point.outcome.triangles)),
                                     fewest_swept, most_swept);
    const auto steps = static_cast<int>(std::sqrt(meshes));
    const auto step = [&](int low, int high) { return std::max(octave / 16, (high - low) / steps); };
    const int normal_step = step(normal_low, normal.coarsest), summed_step = step(summed_low, summed.coarsest);
    shape.ratio = 0;
    for (int n = normal_low; n < normal.coarsest + normal_step; n += normal_step)
        for (int s = summed_low; s < summed.coarsest + summed_step; s += summed_step) {
            const Candidate candidate = measured(shape, {n, s, shape.view});
            if (goal_.met(candidate.point.outcome))
                found_.tried.push_back(candidate);
            take(candidate);
        }
    step_done();
}

/// The thresholds that may be moved.
std::vector<int ThresholdSearch::Place::*> ThresholdSearch::axes(const Shape& shape) const {
    std::vector<int Place::*> result;
    if (space_.normal && shape.ratio != summed_height_alone)
        result.push_back(&Place::normal);
    if (space_.summed_height && shape.ratio != normal_alone)
        result.push_back(&Place::summed_height);
    if (space_.view)
        result.push_back(&Place::view);
    return result;
}

/// Moves to the best neighbour, in ever smaller steps, until none is better.
void ThresholdSearch::polish(Candidate from) {
    const std::vector<int Place::*> moving = axes(from.shape);
    // A threshold far below its first step is 0, and one step further it still is.
    from.place.normal = std::max(from.place.normal, normal_levels().finest);
    from.place.summed_height = std::max(from.place.summed_height, summed_height_levels(from.shape.unit).finest);
    from.place.view = std::max(from.place.view, view_levels().finest);
    const int ways = moving.size() == 1 ? 3 : (moving.size() == 2 ? 9 : 27);
    for (int step = octave; step >= octave / 64; step /= 2)
        for (int move = 0; move < most_moves; ++move) {
            Candidate best = from;
            for (int way = 0; way < ways; ++way) {
                Place place = from.place;
                int digits = way;
                for (int Place::*axis : moving) {
                    place.*axis += (digits % 3 - 1) * step;
                    digits /= 3;
                }
                const Candidate candidate = measured(from.shape, place);
                if (goal_.met(candidate.point.outcome) && better(candidate.point, best.point, goal_))
                    best = candidate;
            }
            if (!better(best.point, from.point, goal_))
                break;
            from = best;
        }
    take(from);
    step_done();
}

/// Moves each threshold to the middle of those that give the same mesh.
void ThresholdSearch::settle() {
    Candidate& best = *found_.best;
    for (int Place::*axis : axes(best.shape)) {
        const auto same = [&](int level) {
            Place place = best.place;
            place.*axis = level;
            const Outcome outcome = measured(best.shape, place).point.outcome;
            return outcome.complete && outcome.triangles == best.point.outcome.triangles &&
                   outcome.rms == best.point.outcome.rms && outcome.max == best.point.outcome.max;
        };
        const auto reach = [&](int direction) {
            int from = best.place.*axis;
            for (int step = octave / 2; step > 0; step /= 2)
                if (same(from + direction * step))
                    from += direction * step;
            return from;
        };
        const int low = reach(-1), high = reach(1);
        best.place.*axis = low + (high - low) / 2;
        const Candidate settled = measured(best.shape, best.place);
        best.point.tests = settled.point.tests;
        best.point.outcome = settled.point.outcome;
    }
}

void ThresholdSearch::refine() {
    if (!found_.best)
        return;
    const bool both = space_.normal && space_.summed_height;
    const bool view_besides = space_.view && (space_.normal || space_.summed_height);
    steps_ = 0;
    expected_steps_ = 50;
    for (bool found = true; found && steps_ < 200;) {
        found = space_.triangulation && refine_triangulation();
        found = (both && refine_ratio()) || found;
        found = (space_.generation_limit && job_.tests.generation && refine_generation_limit()) || found;
        found = (view_besides && refine_view()) || found;
    }
    if (both)
        for (const SummedHeightUnit unit : units())
            sweep(unit);
    std::vector<Candidate> starts = found_.tried;
    starts.push_back(*found_.best);
    std::stable_sort(starts.begin(), starts.end(),
                     [&](const Candidate& a, const Candidate& b) { return better(a.point, b.point, goal_); });
    starts.resize(std::min(starts.size(), most_polished));
    for (const Candidate& start : starts)
        polish(start);
    settle();
}

}  // namespace tessera
