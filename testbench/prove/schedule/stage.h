#pragma once
#include <algorithm>
#include <cstdint>

#include "modules/timing/random_stalls.h"
#include "testbench/prove/schedule/history.h"
#include "testbench/prove/schedule/states.h"

namespace tessera::schedule {

/// A buffer at a unit's input.
struct InputPlan {
    unsigned depth = 1;
    RandomStalls stalls{};
};

/// taken[n] = max(offer[n] + stall[n], pop[n - depth])
class Input {
  public:
    explicit Input(const InputPlan& plan) : depth_(plan.depth), stalls_(plan.stalls), pops_(plan.depth) {}

    /// Returns the cycle in which the next item is accepted.
    Cycle take(Cycle offer) { return std::max(offer + stalls_.next(), pops_[taken_++ - depth_]); }
    /// The next item leaves the buffer.
    void pop(Cycle cycle) { pops_.add(cycle); }
    std::uint64_t taken() const { return taken_; }

  private:
    unsigned depth_;
    RandomStalls stalls_;
    std::uint64_t taken_ = 0;
    History pops_;
};

struct PipelinePlan {
    unsigned latency = 1;
    unsigned interval = 1;
    unsigned servers = 1;  ///< parallel pipelines, used round-robin
    unsigned stages = 1;   ///< most items at a time
};

/// start[n] = max(what it needs, start[n - servers] + interval, depart[n - stages])
class Pipeline {
  public:
    explicit Pipeline(const PipelinePlan& plan) : plan_(plan), due_(plan.servers), departs_(plan.stages) {}

    /// The first cycle in which the interval allows the next item to start.
    Cycle due() const { return due_[due_.count() - plan_.servers]; }
    /// Starts the next item and returns the cycle.
    Cycle start(Cycle ready) {
        const Cycle cycle = std::max({ready, due(), departs_[due_.count() - plan_.stages]});
        due_.add(cycle + plan_.interval);
        return cycle;
    }
    /// The next item departs.
    void depart(Cycle cycle) { departs_.add(cycle); }
    Cycle last_depart() const { return departs_[departs_.count() - 1]; }
    unsigned latency() const { return plan_.latency; }

  private:
    PipelinePlan plan_;
    History due_;
    History departs_;
};

struct StagePlan {
    InputPlan input;
    PipelinePlan pipeline;
};

/// A unit with an input and a pipeline. For each item, call in this order: take; start; answer, if it reads a table;
/// finish; blocked, for each consumer in the order of the outputs; depart.
class Stage {
  public:
    explicit Stage(const StagePlan& plan)
        : input_(plan.input), pipeline_(plan.pipeline), level_(plan.pipeline.stages) {}

    Cycle take(Cycle offer) { return taken_ = input_.take(offer); }

    /// asked: the cycle in which the previous item's last request was accepted. operand: the cycle in which the data
    /// that the item waits for arrives from unit `awaited`.
    Cycle start(Cycle asked = 0, Cycle operand = 0, Unit awaited = nobody) {
        const Cycle due = std::max(taken_, pipeline_.due());
        start_ = pipeline_.start(std::max({taken_, asked, operand}));
        input_.pop(start_);
        states_.until(taken_, State::starved);
        states_.until(std::min(start_, due), State::busy);
        states_.until(start_, State::starved, awaited);
        worked_from_ = start_;
        return start_;
    }
    /// The item's last table entry arrives in `cycle`.
    void answer(Cycle cycle, Unit memory) {
        worked_from_ = cycle;
        states_.until(cycle, State::waiting_for_memory, memory);
    }
    /// Returns the cycle in which the item is offered to its consumers.
    Cycle finish() {
        const Cycle finished = worked_from_ + pipeline_.latency();
        states_.until(finished, State::busy);
        return std::max(finished, pipeline_.last_depart());
    }
    /// The consumers up to this one have accepted the item by `cycle`.
    void blocked(Cycle cycle, Unit by) { states_.until(cycle, State::blocked, by); }
    void depart(Cycle cycle) {
        pipeline_.depart(cycle);
        level_.stay(start_, cycle);
    }
    void depart(Cycle cycle, Unit by) {
        blocked(cycle, by);
        depart(cycle);
    }

    States& states() { return states_; }
    Level& level() { return level_; }

  private:
    Input input_;
    Pipeline pipeline_;
    States states_;
    Level level_;
    Cycle taken_ = 0;
    Cycle start_ = 0;
    Cycle worked_from_ = 0;
};

}  // namespace tessera::schedule
