#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "testbench/job/job.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/tune/refinement_forest.h"

namespace tessera {

/// The goal of a search: exactly one of `triangles` and `error` is set.
struct TuneGoal {
    std::uint64_t triangles = 0;       ///< at most this many, with the least error; 0: as few as the error allows
    double error = 0;                  ///< model units, at most; with the fewest triangles
    bool largest = false;              ///< the error is the largest one, not the root mean square
    std::uint64_t most_triangles = 0;  ///< larger meshes are not searched

    double error_of(const Outcome& outcome) const { return largest ? outcome.max : outcome.rms; }
    std::uint64_t limit() const { return triangles > 0 ? triangles : most_triangles; }
    bool met(const Outcome& outcome) const { return outcome.complete && (triangles > 0 || error_of(outcome) <= error); }
};

/// Parameters that the search may change. All others stay as in the job.
struct TuneSpace {
    /// Thresholds. summed_height: or the Curvature Test's, if the job has one.
    bool normal = true, summed_height = true, view = false;
    bool summed_height_unit = true, triangulation = true, generation_limit = true;
};

/// Thresholds and the mesh they give.
struct TunedPoint {
    Job::Tests tests;
    Triangulation triangulation = Triangulation::shorter;
    Outcome outcome;
};

/// Whether a meets the goal better than b.
bool better(const TunedPoint& a, const TunedPoint& b, const TuneGoal& goal);

/// Searches the best thresholds on one base mesh.
///
/// Lowering a threshold nearly always gives more triangles, and mostly less error. So for each ratio of the Normal
/// Test's threshold to the Summed Height Test's there is one level at which the goal is just met: for a budget it is
/// found by bisection, for a bound on the error by descending from the coarsest mesh, since errors are less regular. A
/// ratio of 0 is that of the two thresholds that meet the goal alone, each with the other test off: there both tests
/// contribute alike; at +-4 octaves one test does nearly all.
///
/// explore() tries each test alone and ratios two octaves apart, in both units of the Summed Height Test, and
/// generation limits for each test alone and for the best. refine() improves the best: it varies triangulation, ratio,
/// generation limit and the View Test's threshold in turn until none helps; then tries a coarse grid of both thresholds
/// in both units, and moves those of the best few in ever smaller steps; last, it sets each threshold to the middle of
/// those that give the same mesh, so that no decision depends on rounding. Deterministic: the same job, goal and space
/// give the same thresholds.
class ThresholdSearch {
  public:
    /// Two searched thresholds: their ratio in levels, or one test alone. One or none searched: 0.
    static constexpr int normal_alone = -(1 << 20), summed_height_alone = 1 << 20;

    /// View Test's threshold 0: it stops no edge.
    static constexpr int no_view = -(1 << 20);

    struct Shape {
        SummedHeightUnit unit = SummedHeightUnit::sum;
        Triangulation triangulation = Triangulation::shorter;
        std::int64_t generation_limit = 12;
        int view = no_view;  ///< level, if searched
        int ratio = 0;
    };

    /// Levels of the searched thresholds (threshold_level.h); meaningless for the others.
    struct Place {
        int normal = 0, summed_height = 0, view = no_view;
    };

    struct Candidate {
        TunedPoint point;
        Shape shape;
        Place place;
    };

    struct Found {
        std::optional<Candidate> best;       ///< nothing: no thresholds meet the goal
        std::vector<Candidate> tried;        ///< those that met the goal, in the order tried
        std::uint64_t evaluations = 0;       ///< meshes counted or measured
        std::optional<Outcome> least_error;  ///< with a bound on the error: the least found
    };

    /// All must outlive it. `job`: with a height test that one threshold decides. `on_progress` is called after every shape, with an estimate of the work done, 0..1.
    ThresholdSearch(RefinementForest& forest, const MachineSetup& setup, const Job& job, const TuneGoal& goal,
                    const TuneSpace& space, std::function<void(double)> on_progress);

    void explore();
    void refine();
    const Found& found() const { return found_; }
    /// Continues from another search's result on the same base mesh.
    void start_from(const Found& found) { found_ = found; }

    /// All searched thresholds at 0, the others as in the job: the most triangles it can make.
    datapath::TestParameters finest() const;

  private:
    struct Levels {
        int finest, coarsest;
    };
    using Key = std::tuple<SummedHeightUnit, Triangulation, std::int64_t, int, int>;
    using PlaceAt = std::function<Place(int)>;

    std::vector<SummedHeightUnit> units() const;
    Levels normal_levels() const;
    Levels summed_height_levels(SummedHeightUnit unit) const;
    Levels view_levels() const;
    static Key key_of(const Shape& shape);
    Shape first_shape() const;
    Job::Tests tests_at(const Shape& shape, const Place& place) const;
    datapath::TestParameters registers_of(const Job::Tests& tests) const;
    bool too_fine(const Shape& shape, const Place& place);
    std::optional<int> bisect(const Levels& levels, int low, int high, const Shape& shape, const PlaceAt& at);
    std::optional<int> descend(const Levels& levels, int high, const Shape& shape, const PlaceAt& at);
    std::optional<int> just_met(const Levels& levels, int low, int high, const Shape& shape, const PlaceAt& at);
    std::optional<int> alone(const Shape& shape, int which);
    std::optional<Place> solve(const Shape& shape);
    Candidate measured(const Shape& shape, const Place& place);
    bool take(const Candidate& candidate);
    bool attempt(const Shape& shape);
    bool refine_triangulation();
    bool refine_generation_limit();
    bool try_generation_limits(Shape shape);
    bool refine_view();
    bool refine_ratio();
    std::vector<int Place::*> axes(const Shape& shape) const;
    void sweep(SummedHeightUnit unit);
    void polish(Candidate from);
    void settle();
    void step_done();

    RefinementForest& forest_;
    const MachineSetup& setup_;
    const Job& job_;
    const TuneGoal& goal_;
    const TuneSpace& space_;
    std::function<void(double)> on_progress_;
    HeightTest height_test_;
    const char* height_threshold_;  // a key, or null
    Found found_;
    std::set<Key> done_;
    std::map<Key, std::optional<int>> alone_;
    int steps_ = 0, expected_steps_ = 1;
};

}  // namespace tessera
