#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "testbench/host/setup.h"
#include "testbench/job/job.h"
#include "testbench/tune/refinement_forest.h"

namespace tessera {

/// What thresholds are looked for. One of the two is wanted.
struct TuneGoal {
    std::uint64_t triangles = 0;  ///< at most so many, with the least error; 0: as few as the error allows
    double error = 0;             ///< model units, at most; with the fewest triangles
    bool largest = false;         ///< the error is the largest one, not the root mean square
    std::uint64_t most_triangles = 0;  ///< of a mesh that is looked at all

    double error_of(const Outcome& outcome) const { return largest ? outcome.max : outcome.rms; }
};

/// What may change. The rest stays as the job has it.
struct TuneSpace {
    bool normal = true, summed_height = true, view = false;  ///< thresholds
    bool summed_height_unit = true, triangulation = true, generation_limit = true;
};

/// Thresholds and what they give.
struct TunedPoint {
    Job::Tests tests;
    Triangulation triangulation = Triangulation::shorter;
    Outcome outcome;
};

/// Whether a serves the goal better than b.
bool better(const TunedPoint& a, const TunedPoint& b, const TuneGoal& goal);

/// Looks for the best thresholds on one base mesh.
///
/// More triangles and less error come with every threshold that falls, nearly without exception. So for one ratio of
/// the Normal Test's threshold to the Summed Height Test's there is one level at which the goal is just met, found by
/// bisection; the search is over ratios. A ratio counts from that of the two thresholds which meet the goal alone, each
/// with the other test off: at 0 both tests carry alike, at +-4 octaves one does nearly all. explore() tries each test
/// alone and ratios two octaves apart, in both units of the Summed Height Test; refine() then betters the best step by
/// step: triangulation, generation limit, View Test's threshold, ratios down to a sixteenth of an octave. Nothing is
/// random: the same job, goal and space end in the same thresholds.
class ThresholdSearch {
  public:
    /// Two searched thresholds: their ratio in levels, or one test alone. One or none: 0.
    static constexpr int normal_alone = -(1 << 20), summed_height_alone = 1 << 20;
    /// View Test's threshold 0: it stops no edge.
    static constexpr int no_view = -(1 << 20);

    struct Shape {
        SummedHeightUnit unit = SummedHeightUnit::sum;
        Triangulation triangulation = Triangulation::shorter;
        std::int64_t generation_limit = 12;
        int view = no_view;  ///< level; where not searched, no_view
        int ratio = 0;
    };

    struct Found {
        std::optional<TunedPoint> best;  ///< nothing: no thresholds meet the goal
        Shape best_shape;
        std::vector<TunedPoint> tried;  ///< what met the goal, one for each shape, in the order of trying
        std::uint64_t evaluations = 0;  ///< meshes counted or measured
    };

    /// All must outlive it. `on_progress` is called after every shape, with an estimate of the work done, 0..1.
    ThresholdSearch(RefinementForest& forest, const Setup& setup, const Job& job, const TuneGoal& goal,
                    const TuneSpace& space, std::function<void(double)> on_progress);

    void explore();
    void refine();
    const Found& found() const { return found_; }
    /// Goes on from what another search on the same base mesh found.
    void start_from(const Found& found) { found_ = found; }

    /// All thresholds searched at 0, the job's others: the most triangles it can make.
    datapath::TestParameters finest() const;

  private:
    struct Levels {
        int finest, coarsest;
    };
    using MakeTests = std::function<Job::Tests(int)>;
    using Key = std::tuple<SummedHeightUnit, Triangulation, std::int64_t, int, int>;

    Levels normal_levels() const;
    Levels summed_height_levels(SummedHeightUnit unit) const;
    Levels view_levels() const;
    Job::Tests tests_of(const Shape& shape) const;
    datapath::TestParameters registers_of(const Job::Tests& tests) const;
    bool too_fine(const Job::Tests& tests, Triangulation triangulation);
    std::optional<int> boundary(const Levels& levels, int low, int high, Triangulation triangulation,
                                const MakeTests& make);
    static Key key_of(const Shape& shape);
    std::optional<int> alone(const Shape& shape, int which);
    std::optional<Job::Tests> solve(const Shape& shape);
    bool attempt(const Shape& shape);
    bool refine_triangulation();
    bool refine_generation_limit();
    bool refine_view();
    bool refine_ratio();
    void step_done();

    RefinementForest& forest_;
    const Setup& setup_;
    const Job& job_;
    const TuneGoal& goal_;
    const TuneSpace& space_;
    std::function<void(double)> on_progress_;
    Found found_;
    std::set<Key> done_;
    std::map<Key, std::optional<int>> alone_;
    int steps_ = 0, expected_steps_ = 1;
};

}  // namespace tessera
