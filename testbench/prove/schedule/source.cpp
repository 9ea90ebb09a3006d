#include "testbench/prove/schedule/source.h"

#include <algorithm>

namespace tessera::schedule {

Source::Source(const SourcePlan& plan)
    : plan_(plan),
      from_host_(plan.from_host),
      from_queue_(plan.from_triangle_queue),
      from_tessellation_(plan.from_tessellation),
      begins_(plan.from_triangle_queue.depth) {}

void Source::send(std::uint64_t triangles) {
    host_triangles_ = triangles;
    if (triangles > 0)
        host_taken_ = from_host_.take(0);
}

Cycle Source::offer(Cycle cycle, std::uint32_t place) {
    const Cycle taken = from_tessellation_.take(cycle);
    const Cycle push = std::max(taken, next_push_);
    next_push_ = push + plan_.queue.interval;
    from_tessellation_.pop(push);
    // A triangle that was accepted earlier, or held back until now, is present when the queue acts by itself.
    pushes_.add({moment(push, push == cycle ? by_tessellation : by_itself), place});
    return taken;
}

/// Computes starts and departures as far as they follow from the triangles that Get Triangle has begun.
void Source::evaluate_pops() {
    for (bool more = true; more;) {
        more = false;
        while (starts_.count() < pushes_.count() && starts_.count() < departs_.count() + plan_.queue.stages) {
            start(starts_.count());
            more = true;
        }
        while (departs_.count() < starts_.count() && departs_.count() < begun_ + plan_.from_triangle_queue.depth) {
            depart(departs_.count());
            more = true;
        }
    }
}

void Source::start(std::uint64_t n) {
    const Moment room = n < plan_.queue.stages ? 0 : departs_[n - plan_.queue.stages];
    const Moment start = std::max({pushes_[n].when, moment(next_start_), room});
    next_start_ = cycle_of(start) + plan_.queue.interval;
    starts_.add(start);
}

void Source::depart(std::uint64_t n) {
    const Moment before = n == 0 ? 0 : departs_[n - 1];
    const Moment offer = std::max(moment(cycle_of(starts_[n]) + plan_.queue.latency), before);
    const Cycle taken = from_queue_.take(cycle_of(offer));
    // Otherwise it is held back, or there is no room until Get Triangle begins another triangle.
    const bool at_once = taken == cycle_of(offer) && begins_[n - plan_.from_triangle_queue.depth] < taken;
    departs_.add(at_once ? offer : moment(taken, by_get_triangle));
    states_.until(cycle_of(pushes_[n].when), State::starved);
    states_.until(cycle_of(offer), State::busy);
    states_.until(taken, State::blocked, get_triangle);
}

/// The place of the triangle that leaves in this pop. All pushes before its start must be known.
std::uint32_t Source::place_of(std::uint64_t pop) {
    if (!plan_.newest_first)
        return pushes_[stored_++].place;
    for (; stored_ < pushes_.count() && pushes_[stored_].when <= starts_[pop]; ++stored_)
        store_.push_back(pushes_[stored_].place);
    const std::uint32_t newest = store_.back();
    store_.pop_back();
    return newest;
}

/// Valid while no triangle is on its way from the queue to Get Triangle.
bool Source::below_watermark(Cycle cycle) {
    while (pushed_before_ < pushes_.count() && cycle_of(pushes_[pushed_before_].when) <= cycle)
        ++pushed_before_;
    return pushed_before_ - begun_ < plan_.watermark;
}

Source::Next Source::next(Cycle free) {
    evaluate_pops();
    Next next;
    const bool queue = begun_ < departs_.count();
    const Cycle arrival = queue ? cycle_of(departs_[begun_]) : 0;
    const Cycle host = std::max(free, host_taken_);
    if (host_triangles_ > 0 && (!queue || host < arrival) && below_watermark(host)) {
        next = {true, true, 0, host};
        from_host_.pop(host);
        if (--host_triangles_ > 0)
            host_taken_ = from_host_.take(host_taken_);
    } else if (queue) {
        next = {true, false, place_of(begun_), std::max(free, arrival)};
        from_queue_.pop(next.begin);
        begins_.add(next.begin);
        ++begun_;
        evaluate_pops();
    } else {
        return next;
    }
    account(next.begin);
    return next;
}

/// Accounts for the queue's level after each push up to cycle `end`. Later departures may not be known yet.
void Source::account(Cycle end) {
    for (; accounted_pushes_ < pushes_.count() && cycle_of(pushes_[accounted_pushes_].when) <= end;
         ++accounted_pushes_) {
        const Moment when = pushes_[accounted_pushes_].when;
        const Cycle cycle = cycle_of(when);
        while (accounted_departs_ < departs_.count() && departs_[accounted_departs_] <= when)
            account_depart();
        left_by_cycle_ = std::max(left_by_cycle_, accounted_departs_);
        while (left_by_cycle_ < departs_.count() && cycle_of(departs_[left_by_cycle_]) <= cycle)
            ++left_by_cycle_;
        const std::uint64_t pushes = accounted_pushes_ + 1;
        history_.set(cycle, pushes - accounted_departs_);
        highest_ = std::max(highest_, pushes - accounted_departs_);
        most_ = std::max({most_, std::uint64_t{1}, pushes - left_by_cycle_});
        item_cycles_ -= cycle;
        if (observer_ != nullptr)
            observer_->item(cycle, true);
    }
    const auto before = [](std::uint64_t count, std::uint64_t back) { return count < back ? 0 : count - back; };
    departs_.forget_before(std::min(
        {accounted_departs_, begun_, before(departs_.count(), 1), before(starts_.count(), plan_.queue.stages)}));
    starts_.forget_before(std::min(departs_.count(), begun_));
    pushes_.forget_before(std::min({accounted_pushes_, stored_, departs_.count(), pushed_before_}));
}

void Source::account_depart() {
    const Cycle cycle = cycle_of(departs_[accounted_departs_++]);
    history_.set(cycle, accounted_pushes_ - accounted_departs_);
    item_cycles_ += cycle;
    if (observer_ != nullptr)
        observer_->item(cycle, false);
}

void Source::finish(Cycle end) {
    account(end);
    while (accounted_departs_ < departs_.count())
        account_depart();
    states_.until(end, State::starved);
    history_.finish(end);
}

}  // namespace tessera::schedule
