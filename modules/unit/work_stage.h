#pragma once
#include <string>
#include <systemc>

#include "modules/stream/stream_input.h"
#include "modules/stream/work.h"
#include "modules/unit/elastic_pipeline.h"
#include "modules/unit/fork.h"
#include "modules/unit/signals.h"
#include "modules/unit/unit.h"

namespace tessera {

/// A unit with one input, a pipeline, and one or more outputs for the same item: how most of them behave in timed mode.
/// A derived unit says what is done to an item, in functions that step() calls without a table: it is a friend of its base.
template <class Derived>
class WorkStage : public Unit {
  public:
    std::string holds() const override {
        return listed(count_of(pipeline_.size() + input_->size(), "item"),
                      input_->holds_back() ? "one at its door" : "");
    }
    std::uint64_t occupied_cycles() const override { return activity_.items_in() * timing_.interval; }

    /// Shows the item started last.
    void show(Signals& signals) const override {
        Unit::show(signals);
        signals.input(*input_);
        signals.group(signals.changed(activity_.items_in()) && !pipeline_.empty(), [&] {
            signals.work(pipeline_.newest());
            unit().trace_item(signals, pipeline_.newest());
        });
    }
    Begun begun() const override { return Begun::of(activity_.items_in(), pipeline_.newest()); }

  protected:
    /// servers: pipelines side by side.
    WorkStage(const sc_core::sc_module_name& name, Clock& clock, const UnitTiming& timing,
              unsigned servers = 1)
        : Unit(name, clock), timing_(timing), pipeline_(timing, servers) {}

    /// To be called once in a derived unit's constructor: its input, and each of its outputs.
    void takes_from(StreamInput<Work>& input, const StallParameters& stalls) {
        input_ = &input;
        input.clocked_by(clock_, *this, timing_.buffer, stalls);
    }
    void delivers_to(StreamOutput<Work>& output) {
        fork_.add(output);
        output.clocked_by(clock_, *this);
    }

    // What a derived unit provides: void process(const Work&), its work on an item, done when it starts; and, if it
    // differs from this,
    /// Which outputs get a finished item.
    unsigned targets(const Work&) const { return ~0u; }
    /// False: the item lacks what another unit has to bring; the unit will be called when it comes.
    bool may_begin(const Work&) { return true; }
    const sc_core::sc_object* lacks() const { return nullptr; }
    /// Shows operands and result of an item that was started, in traces.
    void trace_item(Signals&, const Work&) const {}

    void step() override {
        const std::uint64_t cycle = clock_.last_cycle();
        input_->admit();
        while (pipeline_.front_finished(cycle) &&
               fork_.deliver(pipeline_.front(), unit().targets(pipeline_.front()))) {
            pipeline_.pop();
            activity_.item_out(cycle);
        }
        bool lacking = false;
        while (!input_->empty() && pipeline_.may_start(cycle)) {
            if (!unit().may_begin(input_->front())) {
                lacking = true;
                break;
            }
            Work& work = pipeline_.start(cycle);
            work = input_->front();
            activity_.item_in(cycle);
            unit().process(work);
            input_->pop();
        }
        if (pipeline_.front_finished(cycle))
            activity_.set(cycle, State::blocked, fork_.blocked_by());
        else if (!pipeline_.empty() || (!lacking && !input_->empty()))
            activity_.set(cycle, State::busy);
        else
            activity_.set(cycle, State::starved, lacking ? unit().lacks() : nullptr);
        wake_at(pipeline_.next_finished(cycle));
        if (!input_->empty())
            wake_at(pipeline_.next_start(cycle));
    }

    const UnitTiming timing_;

  private:
    Derived& unit() { return static_cast<Derived&>(*this); }
    const Derived& unit() const { return static_cast<const Derived&>(*this); }

    StreamInput<Work>* input_ = nullptr;
    Fork<Work> fork_;
    ElasticPipeline<Work> pipeline_;
};

}  // namespace tessera
