#pragma once
#include <cstdint>

#include "testbench/explore/thresholds/texel_error.h"
#include "testbench/explore/thresholds/threshold_search.h"
#include "testbench/job/job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// Looks for the one threshold of a Rank Test, or with TuneGoal::largest of a Bound Test, on one base mesh. A threshold
/// that falls only adds vertices, so bisection over the register's values finds the one at which the goal is just met.
/// A bound on the largest error is the Bound Test's threshold itself, which guarantees it, unless another test stops
/// edges that it asks for; then bisection finds a lower one.
class RankSearch {
  public:
    /// Throws InputError on errors as the viewer sees them, which are not searched.
    static void refuse_view(const Job& job);

    /// The job that is searched: a Rank Table with the entries that the goal needs, and the cut that goes with it.
    static Job job_for(const Job& job, const TuneGoal& goal);

    /// setup: of such a job; its threshold changes. All must outlive it.
    RankSearch(MachineSetup& setup, const Job& job, const TexelError& errors, const TuneGoal& goal);

    ThresholdSearch::Found search();

    /// The mesh of a register's value. Stops at `limit` triangles. measured: else they are only counted.
    Outcome outcome(std::uint32_t threshold, std::uint64_t limit, bool measured);
    /// At which no edge splits, or as few as a job file can say.
    std::uint32_t highest() const { return highest_; }
    /// tests.rank_threshold or tests.bound_threshold of a register's value: in the middle of those that give it.
    double threshold_of(std::uint32_t threshold) const;

  private:
    bool met(const Outcome& outcome);
    void take(std::uint32_t threshold, const Outcome& outcome);
    void bisect(std::uint32_t too_high);

    MachineSetup& setup_;
    const Job& job_;
    const TexelError& errors_;
    const TuneGoal& goal_;
    BareRecursion datapath_;
    int bits_;
    std::uint32_t highest_;
    ThresholdSearch::Found found_;
};

}  // namespace tessera
