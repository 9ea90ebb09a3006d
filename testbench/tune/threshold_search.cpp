#include "testbench/tune/threshold_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "testbench/tune/threshold_level.h"

namespace tessera {

namespace {

constexpr int octave = levels_per_octave;
constexpr int widest_ratio = 4 * octave;

double threshold_or_zero(int level, int finest) {
    return level <= finest ? 0 : threshold_at(level);
}

}  // namespace

bool better(const TunedPoint& a, const TunedPoint& b, const TuneGoal& goal) {
    const double error_a = goal.error_of(a.outcome), error_b = goal.error_of(b.outcome);
    if (goal.triangles > 0)
        return error_a != error_b ? error_a < error_b : a.outcome.triangles < b.outcome.triangles;
    return a.outcome.triangles != b.outcome.triangles ? a.outcome.triangles < b.outcome.triangles
                                                      : error_a < error_b;
}

ThresholdSearch::ThresholdSearch(RefinementForest& forest, const Setup& setup, const Job& job,
                                 const TuneGoal& goal, const TuneSpace& space,
                                 std::function<void(double)> on_progress)
    : forest_(forest),
      setup_(setup),
      job_(job),
      goal_(goal),
      space_(space),
      on_progress_(std::move(on_progress)) {
    found_.best_shape.unit = job.tests.summed_height_unit;
    found_.best_shape.triangulation = job.hardware.triangulation;
    found_.best_shape.generation_limit = job.tests.generation_limit;
}

// A threshold below its register's first step is 0; one above all that can be compared with it lets nothing pass.

ThresholdSearch::Levels ThresholdSearch::normal_levels() const {
    return {level_of(std::ldexp(1.0, -setup_.registers.formats.normal.fraction)) - 1, octave};
}

ThresholdSearch::Levels ThresholdSearch::summed_height_levels(SummedHeightUnit unit) const {
    const double highest_code = static_cast<double>(setup_.map.highest_code());
    if (unit == SummedHeightUnit::area)
        return {level_of(1 / highest_code) - 1, octave};
    const double largest = static_cast<double>(setup_.largest_rectangle_sum) / highest_code / 2;
    return {level_of(1 / highest_code / 4) - 1, std::max(level_of(largest), 0)};
}

ThresholdSearch::Levels ThresholdSearch::view_levels() const {
    return {level_of(std::ldexp(1.0, -setup_.registers.formats.screen.fraction)) - 1,
            level_of(static_cast<double>(job_.camera.viewport_width + job_.camera.viewport_height))};
}

Job::Tests ThresholdSearch::tests_of(const Shape& shape) const {
    Job::Tests tests = job_.tests;
    tests.summed_height_unit = shape.unit;
    tests.generation_limit = shape.generation_limit;
    if (space_.view)
        tests.view_threshold = shape.view == no_view ? 0 : threshold_at(shape.view);
    return tests;
}

datapath::TestParameters ThresholdSearch::registers_of(const Job::Tests& tests) const {
    Job job;
    job.tests = tests;
    return make_tests(job, setup_.registers.formats);
}

datapath::TestParameters ThresholdSearch::finest() const {
    Job::Tests tests = job_.tests;
    if (space_.normal)
        tests.normal_threshold = 0;
    if (space_.summed_height)
        tests.summed_height_threshold = 0;
    if (space_.view)
        tests.view_threshold = 0;
    return registers_of(tests);
}

namespace {

datapath::Triangulation machine_name(Triangulation triangulation) {
    return triangulation == Triangulation::first    ? datapath::Triangulation::first
           : triangulation == Triangulation::second ? datapath::Triangulation::second
                                                    : datapath::Triangulation::shorter;
}

}  // namespace

/// More triangles than the budget; or an error within its bound, so that there may be fewer.
bool ThresholdSearch::too_fine(const Job::Tests& tests, Triangulation triangulation) {
    ++found_.evaluations;
    const datapath::TestParameters registers = registers_of(tests);
    if (goal_.triangles > 0)
        return !forest_.count(registers, machine_name(triangulation), goal_.triangles).complete;
    const Outcome outcome = forest_.measure(registers, machine_name(triangulation), goal_.most_triangles);
    return !outcome.complete || goal_.error_of(outcome) <= goal_.error;
}

/// The level at which the goal is just met, from low < high, which are widened until it lies between.
std::optional<int> ThresholdSearch::boundary(const Levels& levels, int low, int high,
                                             Triangulation triangulation, const MakeTests& make) {
    const bool budget = goal_.triangles > 0;
    low = std::clamp(low, levels.finest, levels.coarsest);
    high = std::clamp(high, low, levels.coarsest);
    while (too_fine(make(high), triangulation)) {
        if (high == levels.coarsest)
            return budget ? std::nullopt : std::optional<int>(high);
        low = high;
        high = std::min(levels.coarsest, high + octave);
    }
    while (low >= high || !too_fine(make(low), triangulation)) {
        if (low == levels.finest)
            return budget ? std::optional<int>(low) : std::nullopt;
        high = std::min(low, high);
        low = std::max(levels.finest, low - octave);
    }
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        (too_fine(make(middle), triangulation) ? low : high) = middle;
    }
    return budget ? high : low;
}

ThresholdSearch::Key ThresholdSearch::key_of(const Shape& shape) {
    return {shape.unit, shape.triangulation, shape.generation_limit, shape.view, shape.ratio};
}

/// The level of one test's threshold that meets the goal with the other test off.
std::optional<int> ThresholdSearch::alone(const Shape& shape, int which) {
    Shape of = shape;
    of.ratio = which;
    const auto [at, is_new] = alone_.emplace(key_of(of), std::nullopt);
    if (!is_new)
        return at->second;
    const bool normal = which == normal_alone;
    const Levels levels = normal ? normal_levels() : summed_height_levels(shape.unit);
    const std::optional<int> level =
        boundary(levels, levels.coarsest, levels.coarsest, shape.triangulation, [&](int candidate) {
            Job::Tests tests = tests_of(shape);
            (normal ? tests.summed_height : tests.normal) = false;
            (normal ? tests.normal_threshold : tests.summed_height_threshold) =
                threshold_or_zero(candidate, levels.finest);
            return tests;
        });
    return alone_[key_of(of)] = level;
}

std::optional<Job::Tests> ThresholdSearch::solve(const Shape& shape) {
    const Levels normal = normal_levels(), summed = summed_height_levels(shape.unit);
    const bool both = space_.normal && space_.summed_height;
    if (both && (shape.ratio == normal_alone || shape.ratio == summed_height_alone)) {
        const std::optional<int> level = alone(shape, shape.ratio);
        if (!level)
            return std::nullopt;
        Job::Tests tests = tests_of(shape);
        if (shape.ratio == normal_alone) {
            tests.summed_height = false;
            tests.normal_threshold = threshold_or_zero(*level, normal.finest);
        } else {
            tests.normal = false;
            tests.summed_height_threshold = threshold_or_zero(*level, summed.finest);
        }
        return tests;
    }
    Levels levels{};
    int low = 0, high = 0;
    MakeTests make;
    if (both) {
        const int normal_level = alone(shape, normal_alone).value_or(normal.finest);
        const int summed_level = alone(shape, summed_height_alone).value_or(summed.finest);
        const int half = shape.ratio / 2;
        levels = {std::min(normal.finest - normal_level - half, summed.finest - summed_level + half),
                  std::max(normal.coarsest - normal_level - half, summed.coarsest - summed_level + half)};
        low = std::abs(half) - octave / 32;
        high = std::abs(half) + octave;
        make = [this, shape, normal, summed, normal_level, summed_level, half](int level) {
            const auto threshold = [](int at, const Levels& range) {
                return threshold_or_zero(std::min(at, range.coarsest), range.finest);
            };
            Job::Tests tests = tests_of(shape);
            tests.normal_threshold = threshold(normal_level + level + half, normal);
            tests.summed_height_threshold = threshold(summed_level + level - half, summed);
            return tests;
        };
    } else {
        levels = space_.normal ? normal : (space_.summed_height ? summed : view_levels());
        low = high = levels.coarsest;
        make = [this, shape, levels](int level) {
            Job::Tests tests = tests_of(shape);
            (space_.normal          ? tests.normal_threshold
             : space_.summed_height ? tests.summed_height_threshold
                                    : tests.view_threshold) = threshold_or_zero(level, levels.finest);
            return tests;
        };
    }
    const std::optional<int> level = boundary(levels, low, high, shape.triangulation, make);
    return level ? std::optional<Job::Tests>(make(*level)) : std::nullopt;
}

/// Whether it is the best so far.
bool ThresholdSearch::attempt(const Shape& shape) {
    if (!done_.insert(key_of(shape)).second)
        return false;
    const std::optional<Job::Tests> tests = solve(shape);
    step_done();
    if (!tests)
        return false;
    TunedPoint point;
    point.tests = *tests;
    point.triangulation = shape.triangulation;
    point.outcome = forest_.measure(registers_of(*tests), machine_name(shape.triangulation),
                                    goal_.triangles > 0 ? goal_.triangles : goal_.most_triangles);
    ++found_.evaluations;
    if (!point.outcome.complete)
        return false;
    found_.tried.push_back(point);
    if (found_.best && !better(point, *found_.best, goal_))
        return false;
    found_.best = point;
    found_.best_shape = shape;
    return true;
}

void ThresholdSearch::step_done() {
    ++steps_;
    if (on_progress_)
        on_progress_(std::min(1.0, static_cast<double>(steps_) / expected_steps_));
}

void ThresholdSearch::explore() {
    std::vector<SummedHeightUnit> units{job_.tests.summed_height_unit};
    if (space_.summed_height && space_.summed_height_unit)
        units.push_back(units.front() == SummedHeightUnit::sum ? SummedHeightUnit::area
                                                               : SummedHeightUnit::sum);
    std::vector<int> ratios{0};
    if (space_.normal && space_.summed_height) {
        ratios = {normal_alone, summed_height_alone};
        for (int ratio = -widest_ratio; ratio <= widest_ratio; ratio += 2 * octave)
            ratios.push_back(ratio);
    }
    steps_ = 0;
    expected_steps_ = static_cast<int>(units.size() * ratios.size());
    Shape shape = found_.best_shape;
    for (const SummedHeightUnit unit : units)
        for (const int ratio : ratios) {
            shape.unit = unit;
            shape.ratio = ratio;
            attempt(shape);
        }
    if (space_.generation_limit && job_.tests.generation)
        refine_generation_limit();
}

bool ThresholdSearch::refine_triangulation() {
    const Shape from = found_.best_shape;
    bool found = false;
    for (const Triangulation choice : {Triangulation::shorter, Triangulation::first, Triangulation::second}) {
        Shape shape = from;
        shape.triangulation = choice;
        found = attempt(shape) || found;
    }
    return found;
}

bool ThresholdSearch::refine_generation_limit() {
    const Shape from = found_.best_shape;
    bool found = false;
    // A limit that no vertex reaches changes nothing.
    const std::int64_t reached = found_.best ? found_.best->outcome.generation : 0;
    for (std::int64_t limit = std::min(job_.tests.generation_limit, reached + 2); limit > 0; --limit) {
        Shape shape = from;
        shape.generation_limit = limit;
        found = attempt(shape) || found;
    }
    return found;
}

bool ThresholdSearch::refine_view() {
    const Levels levels = view_levels();
    bool found = false;
    const auto try_view = [&](int view) {
        Shape shape = found_.best_shape;
        shape.view = view;
        found = attempt(shape) || found;
    };
    for (int view = 0; view < levels.coarsest; view += octave)
        try_view(view);
    for (int step = octave / 2; step >= octave / 8; step /= 2) {
        const int view = found_.best_shape.view;
        if (view == no_view)
            break;
        try_view(view - step);
        try_view(view + step);
    }
    return found;
}

bool ThresholdSearch::refine_ratio() {
    bool found = false;
    Shape from = found_.best_shape;
    for (from.ratio = -widest_ratio; from.ratio <= widest_ratio; from.ratio += octave)
        found = attempt(from) || found;
    for (int step = octave / 2; step >= octave / 16; step /= 2) {
        const int ratio = found_.best_shape.ratio;
        if (std::abs(ratio) > widest_ratio + octave)
            break;  // one test alone
        for (const int candidate : {ratio - step, ratio + step}) {
            Shape shape = found_.best_shape;
            shape.ratio = candidate;
            found = attempt(shape) || found;
        }
    }
    return found;
}

void ThresholdSearch::refine() {
    if (!found_.best)
        return;
    const bool both = space_.normal && space_.summed_height;
    const bool view_besides = space_.view && (space_.normal || space_.summed_height);
    steps_ = 0;
    expected_steps_ = 40;
    for (bool found = true; found && steps_ < 200;) {
        found = space_.triangulation && refine_triangulation();
        found = (both && refine_ratio()) || found;
        found = (space_.generation_limit && job_.tests.generation && refine_generation_limit()) || found;
        found = (view_besides && refine_view()) || found;
    }
}

}  // namespace tessera
