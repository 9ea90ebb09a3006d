#include "modules/timing/cycle_scheduler.h"

#include <algorithm>
#include <functional>
#include <string>

namespace tessera {

sc_core::sc_time clock_period(const char* instance, unsigned picoseconds) {
    constexpr std::uint64_t picoseconds_a_second = 1'000'000'000'000;
    const std::uint64_t steps_a_second = sc_core::sc_time(1, sc_core::SC_SEC).value();
    if (steps_a_second < picoseconds_a_second &&
        (steps_a_second == 0 || picoseconds % (picoseconds_a_second / steps_a_second) != 0)) {
        const std::string message =
            std::string(instance) + ": a clock period of " + std::to_string(picoseconds) +
            " ps is not a multiple of SystemC's time resolution, " + sc_core::sc_get_time_resolution().to_string() +
            "; choose another period, or call sc_set_time_resolution(1, SC_PS) before any module is constructed";
        SC_REPORT_ERROR("tessera/clock", message.c_str());
    }
    return sc_core::sc_time(picoseconds, sc_core::SC_PS);
}

sc_core::sc_time first_rising_edge(const sc_core::sc_clock& clock) {
    return clock.posedge_first() ? clock.start_time()
                                 : clock.start_time() + clock.period() - clock.period() * clock.duty_cycle();
}

CycleScheduler::CycleScheduler(const sc_core::sc_module_name& name, const sc_core::sc_time& period,
                               const sc_core::sc_time& first_edge)
    : sc_module(name), period_time_(period), first_edge_(first_edge), period_(period.value()) {
    if (period_ == 0)
        SC_REPORT_ERROR("tessera/clock", "the clock's period is zero");
    most_cycles_ = (UINT64_MAX - first_edge.value()) / period_;
    for (std::size_t cycles = 0; cycles < delays_.size(); ++cycles)
        delays_[cycles] = sc_core::sc_time::from_value(cycles * period_);
    far_.reserve(most_units);
    SC_HAS_PROCESS(CycleScheduler);
    SC_METHOD(tick);
    dont_initialize();
    sensitive << tick_event_;
}

void CycleScheduler::attach(CycleProcess& unit) {
    if (attached_ == most_units) {
        SC_REPORT_ERROR("tessera/clock", "more than 64 units on one clock");
        return;
    }
    unit.bit_ = std::uint64_t{1} << attached_;
    units_[attached_++] = &unit;
}

void CycleScheduler::wake_far(const CycleProcess& unit, std::uint64_t cycle) {
    far_.emplace_back(cycle, unit.bit_);
    std::push_heap(far_.begin(), far_.end(), std::greater<>());
}

void CycleScheduler::wake_from_outside(const CycleProcess& unit, std::uint64_t cycle) {
    // The table starts at the last cycle in which processes were called, which may be ahead of simulated time.
    cycle = std::max({cycle, first_cycle_not_before_now(), cycle_});
    if (cycle - cycle_ < span) {
        due_[cycle % span] |= unit.bit_;
        last_due_ = std::max(last_due_, cycle);
    } else {
        wake_far(unit, cycle);
    }
    if (halted_)
        return;
    if (cycle > most_cycles_) {
        end_time();
    } else if (!scheduled_ || cycle < next_tick_) {
        scheduled_ = true;
        next_tick_ = cycle;
        tick_event_.notify(first_edge_ + sc_core::sc_time::from_value(cycle * period_) - sc_core::sc_time_stamp());
    }
}

void CycleScheduler::end_time() {
    out_of_time_ = true;
    halt();
    quiet_.notify(lag_);
}

void CycleScheduler::take_far() {
    while (!far_.empty() && far_.front().first - cycle_ < span) {
        due_[far_.front().first % span] |= far_.front().second;
        last_due_ = std::max(last_due_, far_.front().first);
        std::pop_heap(far_.begin(), far_.end(), std::greater<>());
        far_.pop_back();
    }
}

bool CycleScheduler::find_next(std::uint64_t& next) const {
    for (std::uint64_t cycle = cycle_ + 1; cycle <= last_due_; ++cycle) {
        if (due_[cycle % span] != 0) {
            next = cycle;
            return true;
        }
    }
    if (far_.empty())
        return false;
    next = far_.front().first;
    return true;
}

/// Calls the processes that are due in the present cycle until none is left. Returns their bits, if observed.
template <bool Observed>
std::uint64_t CycleScheduler::call_due() {
    std::uint64_t called = 0;
    for (unsigned calls = 0; due_now_ != 0; ++calls) {
        if (calls == calls_in_a_cycle)
            SC_REPORT_ERROR("tessera/clock", "a cycle does not end: units keep waking one another");
        const auto unit = static_cast<unsigned>(__builtin_ctzll(due_now_));
        if constexpr (Observed)
            called |= due_now_ & -due_now_;
        due_now_ &= due_now_ - 1;
        units_[unit]->admit_and_step();
    }
    return called;
}

/// Returns false if the present cycle is not observed.
bool CycleScheduler::begin_observing() {
    if (cycle_ < observed_first_)
        return false;
    if (!observer_began_) {
        observer_began_ = true;
        observer_->begin(cycle_);
    }
    if (cycle_ > observed_last_)
        observer_ = nullptr;
    return observer_ != nullptr;
}

/// Whether the kernel had nothing to do until the next cycle, `cycles` after the present one, when it was last asked:
/// asking is slow.
bool CycleScheduler::may_run_ahead(std::uint64_t cycles) {
    if (observer_ != nullptr)
        return false;
    if (until_asked_ == 0) {
        until_asked_ = cycles_between_questions;
        if (sc_core::sc_pending_activity_at_current_time())
            return false;
        next_event_ =
            sc_core::sc_pending_activity_at_future_time() ? sc_core::sc_time_to_pending_activity().value() : UINT64_MAX;
    }
    --until_asked_;
    return next_event_ > lag_.value() + cycles * period_;
}

void CycleScheduler::tick() {
    until_asked_ = 0;
    for (unsigned ahead = 0; run_cycle() && ahead < most_ahead_ && may_run_ahead(next_tick_ - cycle_); ++ahead)
        lag_ += duration(next_tick_ - cycle_);
    if (scheduled_)
        tick_event_.notify(lag_ + duration(next_tick_ - cycle_));
    lag_ = sc_core::SC_ZERO_TIME;
}

/// Returns false if no further cycle is scheduled.
bool CycleScheduler::run_cycle() {
    cycle_ = next_tick_;
    running_ = true;
    scheduled_ = false;
    ++cycles_without_progress_;
    take_far();
    const std::uint64_t place = cycle_ % span;
    due_now_ = due_[place];
    due_[place] = 0;
    if (observer_ != nullptr && begin_observing()) {
        const std::uint64_t called = call_due<true>();
        observer_->end_of_cycle(cycle_, called);
    } else {
        call_due<false>();
    }
    running_ = false;
    if (cycles_without_progress_ > most_without_progress_ && most_without_progress_ != 0) {
        stalled_ = true;
        halt();
    }
    if (halted_ || !find_next(next_tick_))
        quiet_.notify(lag_);
    else if (next_tick_ > most_cycles_)
        end_time();
    else
        scheduled_ = true;
    return scheduled_;
}

}  // namespace tessera
