#pragma once
#include <algorithm>

#include "testbench/prove/schedule/facts.h"
#include "testbench/prove/schedule/plan.h"

namespace tessera::schedule {

/// A triangle in Pass or Tessellate.
struct Join {
    Cycle first_edge = 0;           ///< arrival of the first edge, if before `open`
    Cycle open = 0;                 ///< when the triangle got a place
    Cycle geometry = 0, tests = 0;  ///< last part of each branch
    Cycle start = 0, finish = 0, depart = 0;
    Unit to = nobody;
    bool has_edges = false;
};

/// The units that a triangle passes through once all of its parts have arrived: Pass or Tessellate's pipeline, then
/// either Lighting and the rasteriser, or Tessellation, which fills the queue. Triangles are processed in order, so the
/// cycles of a triangle do not depend on later ones.
class Backend {
  public:
    Backend(const Plan& plan, Source& source)
        : tessellation_plan_(plan.tessellation),
          source_(source),
          join_(plan.join),
          join_level_(plan.join_places + plan.join.stages),
          tessellation_input_(plan.tessellation_input),
          lighting_(plan.lighting),
          rasteriser_(plan.rasteriser) {}

    /// The next triangle is complete from this cycle on. Returns the cycle in which it leaves its place.
    Cycle start(Cycle complete) { return join_.start(complete); }
    /// Sends the triangle that started last where `facts` says.
    void decide(Join& join, const Facts& facts) {
        join.finish = join.start + join_.latency();
        const Cycle offer = std::max(join.finish, join_.last_depart());
        join.depart = offer;
        if (facts.way == Way::lighting) {
            join.to = lighting;
            join.depart = light(offer);
        } else if (facts.way == Way::tessellation) {
            join.to = tessellation;
            join.depart = split(offer, facts);
        }
        join_.depart(join.depart);
        join_level_.stay(join.open, join.depart);
        last_ = std::max(last_, join.depart);
    }
    /// Accounts for Pass or Tessellate's states, triangle by triangle. first_edge: the cycle in which the first edge
    /// arrived of the triangles that had no place.
    void account(const Join& join, Cycle first_edge) {
        join_states_.until(std::min(join.open, first_edge), State::starved);
        join_states_.until(join.open, State::starved, transform);
        join_states_.until(std::min(join.geometry, join.tests), State::starved);
        if (join.geometry <= join.tests)
            join_states_.until(join.tests, State::starved, collect_tests);
        else
            join_states_.until(join.geometry, State::starved, transform);
        join_states_.until(join.finish, State::busy);
        join_states_.until(join.depart, State::blocked, join.to);
    }

    /// The last cycle in which a triangle left, or reached the rasteriser.
    Cycle last() const { return last_; }

    /// each(unit, states, level)
    template <class Each>
    void for_each_unit(Each&& each) {
        each(pass_or_tessellate, join_states_, join_level_);
        each(tessellation, tessellation_states_, tessellation_level_);
        each(lighting, lighting_.states(), lighting_.level());
    }

  private:
    /// Returns the cycle in which Lighting accepts the triangle.
    Cycle light(Cycle offer) {
        const Cycle taken = lighting_.take(offer);
        lighting_.start();
        const Cycle lit = rasteriser_.take(lighting_.finish());
        rasteriser_.pop(lit);
        lighting_.depart(lit, rasteriser);
        last_ = std::max(last_, lit);
        return taken;
    }
    /// Returns the cycle in which Tessellation accepts the triangle.
    Cycle split(Cycle offer, const Facts& facts) {
        const Cycle taken = tessellation_input_.take(offer);
        const Cycle begin = std::max(taken, tessellated_);
        tessellation_input_.pop(begin);
        tessellation_states_.until(begin, State::starved);
        next_child_ = std::max(next_child_, begin + tessellation_plan_.latency);
        tessellated_ = begin;
        for (unsigned k = 0; k < facts.children; ++k) {
            const Cycle sent = std::max(next_child_, tessellated_);
            next_child_ = sent + tessellation_plan_.interval;
            tessellated_ = source_.offer(sent, facts.place[k]);
            tessellation_states_.until(sent, State::busy);
            tessellation_states_.until(tessellated_, State::blocked, triangle_queue);
        }
        tessellation_level_.stay(begin, tessellated_);
        return taken;
    }

    PipelinePlan tessellation_plan_;
    Source& source_;
    Pipeline join_;
    States join_states_;
    Level join_level_;
    Input tessellation_input_;
    Cycle tessellated_ = 0;  // in which the last child was accepted
    Cycle next_child_ = 0;   // from which the next child may be sent
    States tessellation_states_;
    Level tessellation_level_{1};
    Stage lighting_;
    Input rasteriser_;
    Cycle last_ = 0;
};

}  // namespace tessera::schedule
