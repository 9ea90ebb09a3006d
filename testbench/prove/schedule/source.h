#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/timing/level_history.h"
#include "testbench/prove/schedule/sequence.h"
#include "testbench/prove/schedule/stage.h"

namespace tessera::schedule {

struct SourcePlan {
    InputPlan from_host;            ///< of Get Triangle
    InputPlan from_triangle_queue;  ///< likewise
    InputPlan from_tessellation;    ///< of the Triangle Queue
    PipelinePlan queue;
    bool newest_first = false;
    std::uint64_t watermark = 1;
    Unit get_triangle = nobody;
};

/// The two sources of Get Triangle's triangles: the host, and an unbounded Triangle Queue.
///
/// Cycles of the n-th triangle that enters the queue and of the n-th that leaves it:
///     push[n] = max(taken[n], push[n - 1] + interval)
///     start[n] = max(push[n], start[n - 1] + interval, depart[n - stages])
///     depart[n] = accepted by Get Triangle, offered from max(start[n] + latency, depart[n - 1]) on
/// The triangle that starts is the oldest one pushed before or, last in first out, the newest.
///
/// Within a cycle the queue first acts by itself, then on what Tessellation sends, then on what Get Triangle accepts.
/// Which triangle is the newest and the queue's highest level depend on that order, so its times include a phase.
class Source {
  public:
    explicit Source(const SourcePlan& plan);

    /// The host offers this many triangles, from cycle 0 on. Call once.
    void send(std::uint64_t triangles);
    /// Tessellation offers the queue a child, kept in `place`. Returns the cycle in which it is accepted.
    Cycle offer(Cycle cycle, std::uint32_t place);

    struct Next {
        bool any = false;  ///< false: nothing is left to do
        bool from_host = false;
        std::uint32_t place = 0;  ///< if not from the host
        Cycle begin = 0;
    };
    /// The next triangle for Get Triangle, which can begin one from cycle `free` on.
    Next next(Cycle free);

    /// Completes the figures at the end of a run.
    void finish(Cycle end);

    void observe(ItemObserver* observer) { observer_ = observer; }

    const States& states() const { return states_; }
    std::uint64_t pushed() const { return pushes_.count(); }
    std::uint64_t item_cycles() const { return item_cycles_; }
    /// Highest level at the end of a cycle.
    std::uint64_t most() const { return most_; }
    /// Highest level at any time, also within a cycle.
    std::uint64_t highest() const { return highest_; }
    const LevelHistory& history() const { return history_; }

  private:
    /// A cycle and its phase: four times the cycle plus one of these.
    using Moment = std::uint64_t;
    enum Phase : Moment { by_itself = 0, by_tessellation = 1, by_get_triangle = 2 };
    static constexpr Moment moment(Cycle cycle, Phase phase = by_itself) { return 4 * cycle + phase; }
    static constexpr Cycle cycle_of(Moment moment) { return moment / 4; }

    struct Push {
        Moment when = 0;
        std::uint32_t place = 0;
    };

    void evaluate_pops();
    void start(std::uint64_t pop);
    void depart(std::uint64_t pop);
    std::uint32_t place_of(std::uint64_t pop);
    bool below_watermark(Cycle cycle);
    void account(Cycle end);
    void account_depart();

    SourcePlan plan_;
    Input from_host_, from_queue_, from_tessellation_;
    std::uint64_t host_triangles_ = 0;  // not yet begun
    Cycle host_taken_ = 0;              // in which the buffer accepts the next of them
    History begins_;                    // of triangles from the queue
    Sequence<Push> pushes_;
    Sequence<Moment> starts_, departs_;  // of triangles that leave the queue
    std::vector<std::uint32_t> store_;   // last in first out: pushed, not started
    std::uint64_t stored_ = 0;           // pushes moved to store_ or, first in first out, started
    std::uint64_t begun_ = 0;            // triangles from the queue
    std::uint64_t pushed_before_ = 0;    // pushes up to the cycle last asked about
    Cycle next_push_ = 0;
    Cycle next_start_ = 0;

    // The queue's figures, up to the last push accounted for.
    States states_;
    LevelHistory history_;
    std::uint64_t accounted_pushes_ = 0;
    std::uint64_t accounted_departs_ = 0;
    std::uint64_t left_by_cycle_ = 0;
    std::uint64_t most_ = 0;
    std::uint64_t highest_ = 0;
    std::uint64_t item_cycles_ = 0;
    ItemObserver* observer_ = nullptr;
};

}  // namespace tessera::schedule
