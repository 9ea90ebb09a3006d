#pragma once
#include <cstdint>

#include "testbench/job/job.h"
#include "testbench/machine/bare_recursion.h"
#include "testbench/machine/machine_setup.h"
#include "testbench/tune/texel_error.h"
#include "testbench/tune/threshold_search.h"

namespace tessera {

/// Searches the threshold of a Rank Test, or with TuneGoal::largest of a Bound Test, on one base mesh. Lowering the
/// threshold only adds vertices, so bisection over the register's values finds the one at which the goal is just met. A
/// bound on the largest error is the Bound Test's threshold itself, which guarantees it, unless another test stops
/// edges that the Bound Test would split; then bisection finds a lower one.
class RankSearch {
  public:
    /// Throws InputError if errors are measured as seen from the eye: such errors are not searched.
    static void refuse_view(const Job& job);

    /// The job to search: with a Rank Table that has the entries needed by the goal, and the matching triangulation.
    static Job job_for(const Job& job, const TuneGoal& goal);

    /// setup: of such a job; its threshold is modified. All must outlive the search.
    RankSearch(MachineSetup& setup, const Job& job, const TexelError& errors, const TuneGoal& goal);

    ThresholdSearch::Found search();

    /// The mesh for a register value. Stops at `limit` triangles. measured: measure errors too, not only count.
    Outcome outcome(std::uint32_t threshold, std::uint64_t limit, bool measured);
    /// The register value at which no edge splits, or the highest that a job file can express.
    std::uint32_t highest() const { return highest_; }
    /// tests.rank_threshold or tests.bound_threshold for a register value: the middle of those that round to it.
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
