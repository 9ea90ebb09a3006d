#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/memory/memory_port.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/work.h"
#include "modules/unit/elastic_pipeline.h"
#include "modules/unit/fork.h"
#include "modules/unit/signals.h"
#include "modules/unit/unit.h"

namespace tessera {

/// What a TableStage keeps of an item; units add their own.
struct TableItem {
    Work work;
    unsigned requests = 0;  ///< reads the item takes
    unsigned asked = 0;     ///< of these, offered to the memory
    unsigned answered = 0;  ///< of these, come back
};

/// A unit whose items read a table, in timed mode: an item starts when the reads of the one before have been taken by
/// the memory; it is finished a latency after its last answer. Enough register stages that the memory's own latency
/// holds nothing up: ceil((latency + memory latency) / interval).
/// A derived unit says what is done to an item, in functions that step() calls without a table: it is a friend of its base.
template <class Derived, class Item>
class TableStage : public Unit {
  public:
    std::string holds() const override {
        const std::string items = listed(count_of(pipeline_.size() + input_->size(), "item"),
                                         port_->on_offer() ? "a request its memory does not take" : "");
        return listed(items, input_->holds_back() ? "one at its door" : "");
    }
    std::uint64_t occupied_cycles() const override { return activity_.items_in() * timing_.interval; }

    /// Shows the item started last, the request made last, how many requests and reads there were, and the item whose
    /// last read came last.
    void show(Signals& signals) const override {
        Unit::show(signals);
        signals.input(*input_);
        signals.group(signals.changed(activity_.items_in()) && !pipeline_.empty(), [&] {
            signals.work(pipeline_.newest().work);
            unit().trace_item(signals, pipeline_.newest());
        });
        signals.pulse("request", port_->requests());
        signals.value("requests", 32, port_->requests());
        signals.value("reads", 32, port_->reads());
        signals.flag("request_held", port_->on_offer());
        signals.value("requests_under_way", 16, port_->requests_under_way());
        signals.group(signals.changed(port_->reads()) && port_->under_way(),
                      [&] { signals.value("address", 32, port_->last_address()); });
        signals.group(signals.changed(activity_.items_out() + waiting_) && waiting_ > 0, [&] {
            const Item& item = waiting_ > 0 ? pipeline_.at(waiting_ - 1) : pipeline_.newest();
            signals.value("answered_triangle", 32, Signals::pass_of(item.work).number);
            signals.value("answered_part", Signals::part_bits, Signals::part_of(item.work));
            unit().trace_answered(signals, item);
        });
    }
    Begun begun() const override { return Begun::of(activity_.items_in(), pipeline_.newest().work); }

  protected:
    TableStage(const sc_core::sc_module_name& name, Clock& clock, const UnitTiming& timing,
               unsigned memory_latency)
        : Unit(name, clock), timing_(timing), pipeline_(timing, 1, memory_latency) {}

    /// To be called once in a derived unit's constructor: its input, its output, and the port it reads through.
    void takes_from(StreamInput<Work>& input, const StallParameters& stalls) {
        input_ = &input;
        input.clocked_by(clock_, *this, timing_.buffer, stalls);
    }
    void delivers_to(StreamOutput<Work>& output) {
        output_.add(output);
        output.clocked_by(clock_, *this);
    }
    /// most_requests: of one item.
    void reads_through(MemoryPort& port, unsigned most_requests) {
        port_ = &port;
        port.clocked_by(clock_, *this, pipeline_.capacity() * most_requests);
    }

    // What a derived unit provides:
    //   unsigned begin(Item&)          its work on an item before its reads; returns how many requests it makes
    //   void ask(Item&, unsigned k)    makes request k of an item
    //   void receive(Item&, unsigned k)    the answer to request k is there (port.entry); with the last one the item's
    //                                      work is completed
    // and, if it differs from this,
    /// False: the item ends here.
    bool goes_on(const Item&) const { return true; }
    /// False: the item lacks what another unit has to bring; the unit will be called when it comes.
    bool may_begin(const Work&) { return true; }
    /// Shows operands of an item that was started, and results of one whose reads have come, in traces.
    void trace_item(Signals&, const Item&) const {}
    void trace_answered(Signals&, const Item&) const {}

    void step() override {
        const std::uint64_t cycle = clock_.last_cycle();
        input_->admit();
        take_answers(cycle);
        while (pipeline_.front_finished(cycle)) {
            Item& item = pipeline_.front();
            if (unit().goes_on(item) && !output_.deliver(item.work))
                break;
            pipeline_.pop();
            --asking_;
            --waiting_;
            activity_.item_out(cycle);
        }
        bool lacking = false;
        while (ask_all() && !input_->empty() && pipeline_.may_start(cycle)) {
            if (!unit().may_begin(input_->front())) {
                lacking = true;
                break;
            }
            Item& item = pipeline_.start(cycle);
            item = Item{};
            item.work = input_->front();
            activity_.item_in(cycle);
            item.requests = unit().begin(item);
            if (item.requests > 0)
                pipeline_.finish(pipeline_.size() - 1, never);
            input_->pop();
        }
        skip_finished();
        if (pipeline_.front_finished(cycle))
            activity_.set(cycle, State::blocked, output_.blocked_by());
        else if (waiting_ == 0 && port_->under_way())
            activity_.set(cycle, State::waiting_for_memory, port_->memory());
        else
            activity_.set(
                cycle, !pipeline_.empty() || (!lacking && !input_->empty()) ? State::busy : State::starved);
        const std::uint64_t finished = pipeline_.next_finished(cycle);
        if (finished != never)
            wake_at(finished);
        if (!input_->empty())
            wake_at(pipeline_.next_start(cycle));
    }

    const UnitTiming timing_;

  private:
    Derived& unit() { return static_cast<Derived&>(*this); }
    const Derived& unit() const { return static_cast<const Derived&>(*this); }

    void take_answers(std::uint64_t cycle) {
        while (port_->answered()) {
            skip_finished();
            Item& item = pipeline_.at(waiting_);
            unit().receive(item, item.answered);
            port_->pop_answer();
            if (++item.answered == item.requests)
                pipeline_.finish(waiting_, cycle + pipeline_.latency());
        }
        skip_finished();
    }

    /// Past the items whose answers have all come.
    void skip_finished() {
        while (waiting_ < pipeline_.size() &&
               pipeline_.at(waiting_).answered == pipeline_.at(waiting_).requests)
            ++waiting_;
    }

    /// Offers the memory as many of the started items' requests as it takes. True: all.
    bool ask_all() {
        while (asking_ < pipeline_.size()) {
            Item& item = pipeline_.at(asking_);
            while (item.asked < item.requests) {
                if (!port_->may_request())
                    return false;
                unit().ask(item, item.asked++);
            }
            ++asking_;
        }
        return !port_->on_offer();
    }

    StreamInput<Work>* input_ = nullptr;
    MemoryPort* port_ = nullptr;
    Fork<Work> output_;
    ElasticPipeline<Item> pipeline_;
    std::size_t asking_ = 0;   // the first item that has not asked for all it needs
    std::size_t waiting_ = 0;  // the first item whose answers have not all come
};

}  // namespace tessera
