#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/schedule/sequence.h"
#include "modules/schedule/stage.h"
#include "modules/timing/level_history.h"

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

/// Where Get Triangle's triangles come from: the host, and an unbounded Triangle Queue.
///
/// The queue, of its n-th triangle in and its n-th out:
///     push[n] = max(taken[n], push[n - 1] + interval)
///     start[n] = max(push[n], start[n - 1] + interval, depart[n - stages])
///     depart[n] = taken by Get Triangle, from max(start[n] + latency, depart[n - 1]) on
/// The triangle that starts is the oldest, or the newest of those pushed before.
///
/// Within a cycle the queue acts by itself, then on what Tessellation sends, then on what Get Triangle takes. Which
/// triangle is the newest depends on that order, and so does the queue's highest level: its times have a phase.
class Source {
  public:
    explicit Source(const SourcePlan& plan);

    /// The host has so many triangles more, from this cycle on.
    void send(std::uint64_t triangles, Cycle cycle);
    /// Tessellation offers a child to the queue, kept in `place`. Returns when it is taken.
    Cycle offer(Cycle cycle, std::uint32_t place);

    struct Next {
        bool any = false;  ///< else nothing is left to do
        bool from_host = false;
        std::uint32_t place = 0;  ///< if not
        Cycle begin = 0;
    };
    /// Get Triangle can begin a triangle from cycle `free` on.
    Next next(Cycle free);

    /// Of a Get Triangle that asks in the order of time, and can begin one in cycle `now`: in which cycle that is or, later,
    /// it is to ask again; ~0: when something was offered or sent.
    Cycle due(Cycle now);

    /// Accounts for all that has happened, at the end of a run.
    void finish(Cycle end);

    void observe(ItemObserver* observer) { observer_ = observer; }

    const States& states() const { return states_; }
    std::uint64_t pushed() const { return pushes_.count(); }
    std::uint64_t item_cycles() const { return item_cycles_; }
    /// At the end of a cycle.
    std::uint64_t most() const { return most_; }
    /// At any time.
    std::uint64_t highest() const { return highest_; }
    std::uint64_t highest_in_store() const { return highest_in_store_; }
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
    std::uint64_t host_triangles_ = 0;  // that have not been taken from the buffer
    Cycle host_taken_ = 0;              // into the buffer: the next of them
    History begins_;                    // of triangles from the queue
    Sequence<Push> pushes_;
    Sequence<Moment> starts_, departs_;  // of triangles that leave the queue
    std::vector<std::uint32_t> store_;   // newest first: pushed, not started
    std::uint64_t stored_ = 0;           // pushes that have been put there
    std::uint64_t begun_ = 0;            // triangles from the queue
    std::uint64_t pushed_before_ = 0;    // the cycle last asked about
    Cycle next_push_ = 0;
    Cycle next_start_ = 0;

    // The queue's figures, up to some push.
    States states_;
    LevelHistory history_;
    std::uint64_t accounted_pushes_ = 0;
    std::uint64_t accounted_departs_ = 0;
    std::uint64_t accounted_starts_ = 0;
    std::uint64_t left_by_cycle_ = 0;
    std::uint64_t most_ = 0;
    std::uint64_t highest_ = 0;
    std::uint64_t highest_in_store_ = 0;
    std::uint64_t item_cycles_ = 0;
    ItemObserver* observer_ = nullptr;
};

}  // namespace tessera::schedule
