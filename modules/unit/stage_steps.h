#pragma once
#include <algorithm>
#include <string>
#include <type_traits>

#include "modules/memory/memory_port.h"
#include "modules/unit/signals.h"
#include "modules/unit/stage.h"

namespace tessera {

// How a Stage does what stage.h says. To be included where one is instantiated.

/// Calls `each(part)` for each part of an item: what timed mode sends one after another and functional mode together.
template <class Item, class Each>
void for_each_part(const Item& whole, Each&& each) {
    each(whole);
}
template <class Each>
void for_each_part(const Work& whole, Each&& each) {
    for (unsigned left = whole.parts; left != 0; left &= left - 1)
        each(Work{whole.pass, static_cast<Parts>(left & -left)});
}

template <class In, class Out>
Stage<In, Out>::Stage(const sc_core::sc_module_name& name, Clock& clock, const UnitTiming& timing,
                      unsigned servers, unsigned memory_latency)
    : Unit(name, clock), timing_(timing), servers_(servers), pipeline_(timing, servers, memory_latency) {}

template <class In, class Out>
void Stage<In, Out>::takes_from(StreamInput<In>& input, const StallParameters& stalls) {
    input_ = &input;
    input.template serve<&Stage::b_transport>(*this);
    input.clocked_by(clock_, *this, timing_.buffer, stalls);
}

template <class In, class Out>
void Stage<In, Out>::delivers_to(StreamOutput<Out>& output, Parts only) {
    fork_.add(output, only);
    output.clocked_by(clock_, *this);
}

template <class In, class Out>
void Stage<In, Out>::reads_through(MemoryPort& port, unsigned most_requests) {
    port_ = &port;
    port.clocked_by(clock_, *this, pipeline_.capacity() * most_requests);
}

template <class In, class Out>
void Stage<In, Out>::b_transport(In& item, sc_core::sc_time& delay) {
    Out result{};
    for_each_part(item, [&](const In& part) {
        if (!may_start(part))
            SC_REPORT_ERROR("tessera/stage",
                            (std::string(name()) + ": an item came before what it waits for").c_str());
        delay = std::max(delay, may_start_after(part));
        result = read_and_process(part, delay);
    });
    delay += clock_.period() * timing_.latency;
    if constexpr (std::is_same_v<In, Out>)
        fork_.b_transport(item, delay);
    else
        fork_.b_transport(result, delay);
}

template <class In, class Out>
Out Stage<In, Out>::read_and_process(const In& part, sc_core::sc_time& delay) {
    Entries entries;
    if (port_ != nullptr) {
        Reads needed;
        reads(part, needed);
        MemoryPort::Burst burst(*port_, delay);
        for (unsigned k = 0; k < needed.entries(); ++k)
            entries[k] = burst.read(needed.addresses()[k]);
    }
    return process(part, entries);
}

template <class In, class Out>
void Stage<In, Out>::start(std::uint64_t cycle) {
    Slot& slot = pipeline_.start(cycle);
    slot.item = input_->front();
    slot.requests = slot.answered = 0;
    activity_.item_in(cycle);
    if (port_ != nullptr) {
        reads_ = Reads{};
        asked_ = asked_entries_ = 0;
        reads(slot.item, reads_);
        slot.requests = static_cast<std::uint8_t>(reads_.requests());
        for (unsigned k = 0; k < reads_.requests(); ++k)
            slot.count[k] = static_cast<std::uint8_t>(reads_.count(k));
    }
    if (slot.requests > 0)
        pipeline_.finish(pipeline_.size() - 1, never);
    else
        slot.result = process(slot.item, entries_);
    input_->pop();
}

/// Makes as many of the started items' requests as the memory takes. True: all.
template <class In, class Out>
bool Stage<In, Out>::ask() {
    for (; asked_ < reads_.requests(); ++asked_) {
        if (!port_->may_request())
            return false;
        port_->request(reads_.addresses() + asked_entries_, reads_.count(asked_));
        asked_entries_ += reads_.count(asked_);
    }
    return !port_->on_offer();
}

template <class In, class Out>
void Stage<In, Out>::take_answers(std::uint64_t cycle) {
    while (port_->answered()) {
        skip_processed();
        Slot& slot = pipeline_.at(waiting_);
        for (unsigned k = 0; k < slot.count[slot.answered]; ++k)
            entries_[come_++] = port_->entry(k);
        port_->pop_answer();
        if (++slot.answered == slot.requests) {
            come_ = 0;
            slot.result = process(slot.item, entries_);
            pipeline_.finish(waiting_, cycle + pipeline_.latency());
        }
    }
    skip_processed();
}

/// Past the items whose answers have all come.
template <class In, class Out>
void Stage<In, Out>::skip_processed() {
    while (waiting_ < pipeline_.size() && pipeline_.at(waiting_).answered == pipeline_.at(waiting_).requests)
        ++waiting_;
}

template <class In, class Out>
void Stage<In, Out>::step() {
    const std::uint64_t cycle = clock_.last_cycle();
    if (port_ != nullptr)
        take_answers(cycle);
    while (pipeline_.front_finished(cycle) && fork_.deliver(pipeline_.front().result)) {
        pipeline_.pop();
        if (port_ != nullptr)
            --waiting_;
        activity_.item_out(cycle);
    }
    bool lacking = false;
    while ((port_ == nullptr || ask()) && !input_->empty() && pipeline_.may_start(cycle)) {
        if (!may_start(input_->front())) {
            lacking = true;
            break;
        }
        start(cycle);
    }
    if (port_ != nullptr)
        skip_processed();
    if (pipeline_.front_finished(cycle))
        activity_.set(cycle, State::blocked, fork_.blocked_by());
    else if (port_ != nullptr && waiting_ == 0 && port_->under_way())
        activity_.set(cycle, State::waiting_for_memory, port_->memory());
    else if (!pipeline_.empty() || (!lacking && !input_->empty()))
        activity_.set(cycle, State::busy);
    else
        activity_.set(cycle, State::starved, lacking ? lacks() : nullptr);
    wake_at(pipeline_.next_finished(cycle));
    if (!input_->empty())
        wake_at(pipeline_.next_start(cycle));
}

template <class In, class Out>
std::uint64_t Stage<In, Out>::occupied_cycles() const {
    return activity_.items_in() * timing_.interval / servers_;
}

template <class In, class Out>
std::string Stage<In, Out>::holds() const {
    std::string text = count_of(pipeline_.size() + input_->size(), "item");
    if (port_ != nullptr && port_->on_offer())
        text = listed(text, "a request its memory does not take");
    return listed(text, input_->holds_back() ? "one at its door" : "");
}

/// Shows the item started last; of a unit that reads, the request made last, how many requests and reads there were, and the
/// item whose last read came last.
template <class In, class Out>
void Stage<In, Out>::show(Signals& signals) const {
    Unit::show(signals);
    signals.input(*input_);
    signals.group(signals.changed(activity_.items_in()) && !pipeline_.empty(), [&] {
        const Slot& newest = pipeline_.newest();
        if constexpr (std::is_same_v<In, Work>)
            signals.work(newest.item);
        trace_started(signals, newest.item);
        if (port_ == nullptr)
            trace_processed(signals, newest.item, newest.result);
    });
    if (port_ == nullptr)
        return;
    signals.pulse("request", port_->requests());
    signals.value("requests", 32, port_->requests());
    signals.value("reads", 32, port_->reads());
    signals.flag("request_held", port_->on_offer());
    signals.value("requests_under_way", 16, port_->requests_under_way());
    signals.group(signals.changed(port_->reads()) && port_->under_way(),
                  [&] { signals.value("address", 32, port_->last_address()); });
    signals.group(signals.changed(activity_.items_out() + waiting_) && waiting_ > 0, [&] {
        const Slot& processed = waiting_ > 0 ? pipeline_.at(waiting_ - 1) : pipeline_.newest();
        if constexpr (std::is_same_v<In, Work>) {
            signals.value("answered_triangle", 32, Signals::pass_of(processed.item).number);
            signals.value("answered_part", Signals::part_bits, Signals::part_of(processed.item));
        }
        trace_processed(signals, processed.item, processed.result);
    });
}

/// A triangle comes without its number.
template <class In, class Out>
Begun Stage<In, Out>::begun() const {
    if constexpr (std::is_same_v<In, Work>)
        return Begun::of(activity_.items_in(), pipeline_.newest().item);
    else
        return {activity_.items_in()};
}

}  // namespace tessera
