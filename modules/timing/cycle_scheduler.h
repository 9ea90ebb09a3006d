#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <systemc>
#include <utility>
#include <vector>

namespace tessera {

class CycleScheduler;

class CycleProcess;

/// An input of a process, at which an item may wait until the scheduler admits it.
class CycleInput {
  public:
    virtual ~CycleInput() = default;
    CycleInput(const CycleInput&) = delete;
    CycleInput& operator=(const CycleInput&) = delete;

  protected:
    CycleInput() = default;

    /// Called before each step of its owner while an item waits.
    virtual void admit() = 0;
    /// Call when an item begins to wait, and when it no longer waits.
    inline void set_waiting(bool waiting);

  private:
    friend class CycleProcess;
    CycleProcess* owner_ = nullptr;
    CycleInput* next_ = nullptr;  // of the same owner
    bool waiting_ = false;
};

/// A process that the scheduler calls: a unit, a memory, a driver.
class CycleProcess {
  public:
    /// Does everything that can happen in the present cycle. May be called several times in a cycle; a call without
    /// cause must change nothing.
    virtual void step() = 0;

    /// `input` must exist as long as its owner is stepped. Call once for each input.
    void add_input(CycleInput& input) {
        input.owner_ = this;
        input.next_ = std::exchange(first_input_, &input);
    }

    CycleProcess() = default;
    virtual ~CycleProcess() = default;
    CycleProcess(const CycleProcess&) = delete;
    CycleProcess& operator=(const CycleProcess&) = delete;

  private:
    friend class CycleInput;
    friend class CycleScheduler;
    void admit_and_step() {
        if (waiting_inputs_ > 0)
            admit();
        step();
    }
    void admit() {
        for (CycleInput* input = first_input_; input != nullptr; input = input->next_)
            if (input->waiting_)
                input->admit();
    }

    CycleInput* first_input_ = nullptr;
    unsigned waiting_inputs_ = 0;
    std::uint64_t bit_ = 0;  // its place among the attached processes
};

void CycleInput::set_waiting(bool waiting) {
    owner_->waiting_inputs_ += waiting ? 1 : -1u;
    waiting_ = waiting;
}

/// Observes the cycles in which a process was called; for tracing.
class CycleObserver {
  public:
    /// Called before the processes of the first observed cycle.
    virtual void begin(std::uint64_t cycle) = 0;
    /// called: the bits (CycleScheduler::bit_of) of the processes called.
    virtual void end_of_cycle(std::uint64_t cycle, std::uint64_t called) = 0;
    virtual ~CycleObserver() = default;
};

/// A clock's period. SC_ERROR, naming the instance, if it is not a multiple of SystemC's time resolution.
sc_core::sc_time clock_period(const char* instance, unsigned picoseconds);

sc_core::sc_time first_rising_edge(const sc_core::sc_clock& clock);

/// The clock of timed mode: calls the processes scheduled for a cycle, and skips cycles without any.
///
/// Within a cycle processes are called in the order of attachment, repeatedly, until none is due: a place freed in a
/// cycle is filled in the same cycle, through all full stages: the combinational ready of a pipeline without skid
/// buffers. The order decides only which of several units that access one memory in the same cycle is served first;
/// downstream units first takes the fewest calls. The simulation is the same on every kernel. One SC_METHOD serves all
/// processes: a wake-up sets a bit in a table instead of notifying an event.
///
/// Capacity: 64 processes. If nothing is scheduled, the run is finished or in a deadlock.
class CycleScheduler : public sc_core::sc_module {
  public:
    /// first_edge: the time at which cycle 0 begins.
    CycleScheduler(const sc_core::sc_module_name& name, const sc_core::sc_time& period,
                   const sc_core::sc_time& first_edge = sc_core::SC_ZERO_TIME);

    /// SC_ERROR beyond the capacity.
    void attach(CycleProcess& unit);

    /// Calls `unit` (again) in the present cycle; from outside a cycle, in the first that begins now or later.
    void wake(const CycleProcess& unit) {
        if (running_)
            due_now_ |= unit.bit_;
        else
            wake_from_outside(unit, first_cycle_not_before_now());
    }

    /// Calls `unit` in a cycle, the present one or later.
    [[gnu::always_inline]] void wake_at(const CycleProcess& unit, std::uint64_t cycle) {
        if (!running_) {
            wake_from_outside(unit, cycle);
        } else if (cycle <= cycle_) {
            due_now_ |= unit.bit_;
        } else if (cycle - cycle_ < span) {
            due_[cycle % span] |= unit.bit_;
            last_due_ = std::max(last_due_, cycle);
        } else {
            wake_far(unit, cycle);
        }
    }

    /// Calls `unit` in the present cycle if that cycle is observed: for a change that an observer may show but that the
    /// unit does not react to.
    void wake_if_observed(const CycleProcess& unit) {
        if (observer_ != nullptr && cycle_ >= observed_first_)
            wake(unit);
    }

    /// The present cycle; between two cycles, the next.
    std::uint64_t cycle() const { return running_ ? cycle_ : first_cycle_not_before_now(); }

    /// The last cycle in which a process was called; within a step, the present one.
    std::uint64_t last_cycle() const { return cycle_; }

    /// `delay` in cycles from now, rounded up.
    std::uint64_t cycles(const sc_core::sc_time& delay) const {
        return delay.value() == 0 ? 0 : (delay.value() + period_ - 1) / period_;
    }
    const sc_core::sc_time& period() const { return period_time_; }

    /// True if nothing is scheduled.
    bool idle() const { return !running_ && !scheduled_; }

    /// Notified at the end of a cycle after which nothing is scheduled, or the clock has halted.
    const sc_core::sc_event& quiet() const { return quiet_; }

    /// Calls nothing after the present cycle.
    void halt() { halted_ = true; }
    bool halted() const { return halted_; }

    /// While the kernel has nothing else to do, runs up to `most` further cycles without returning to it. The kernel is
    /// asked every cycles_between_questions cycles: an event that a step notifies takes effect that much later at most.
    /// Meanwhile simulated time does not advance; a stop takes effect afterwards. For simulations in which only the
    /// machine's units depend on time. Has no effect while an observer is attached.
    void run_ahead(unsigned most) { most_ahead_ = most; }

    /// Call progress() when work is completed (a triangle decided, or lit). The clock halts once processes have been
    /// called in more than `most` cycles (0: no limit) without progress. Cycles without calls do not count, since every
    /// latency ends.
    void progress() { cycles_without_progress_ = 0; }
    void halt_without_progress_for(std::uint64_t most) { most_without_progress_ = most; }
    std::uint64_t most_without_progress() const { return most_without_progress_; }
    /// True if the clock halted for lack of progress.
    bool stalled() const { return stalled_; }

    /// The clock halted because a scheduled cycle begins after the end of SystemC's time, 2^64 - 1 time steps.
    bool out_of_time() const { return out_of_time_; }

    /// Observes cycles `first` to `last`; outside these an observer costs nothing.
    void observe(CycleObserver* observer, std::uint64_t first = 0, std::uint64_t last = UINT64_MAX) {
        observer_ = observer;
        observed_first_ = first;
        observed_last_ = last;
        observer_began_ = false;
    }
    /// True if there is an observer, from which cycle on it may observe.
    bool observed() const { return observer_ != nullptr; }
    /// The process's bit in what an observer receives.
    static std::uint64_t bit_of(const CycleProcess& unit) { return unit.bit_; }

    /// SC_ERROR if one cycle takes more calls than this: a combinational loop.
    static constexpr unsigned calls_in_a_cycle = 100'000;

  private:
    static constexpr std::uint64_t span = 1024;  // cycles ahead that the table covers
    static constexpr unsigned most_units = 64;
    using Far = std::pair<std::uint64_t, std::uint64_t>;  // cycle and bit, beyond the table

    void tick();
    bool run_cycle();
    bool may_run_ahead(std::uint64_t cycles);
    template <bool Observed>
    std::uint64_t call_due();
    bool begin_observing();
    void take_far();
    void wake_far(const CycleProcess& unit, std::uint64_t cycle);
    void wake_from_outside(const CycleProcess& unit, std::uint64_t cycle);
    bool find_next(std::uint64_t& next) const;
    void end_time();
    sc_core::sc_time duration(std::uint64_t cycles) const {
        return cycles < delays_.size() ? delays_[cycles] : sc_core::sc_time::from_value(cycles * period_);
    }
    std::uint64_t first_cycle_not_before_now() const {
        const sc_core::sc_time& now = sc_core::sc_time_stamp();
        return now <= first_edge_ ? 0 : cycles(now - first_edge_);
    }

    sc_core::sc_time period_time_;
    sc_core::sc_time first_edge_;
    std::uint64_t period_;
    std::uint64_t most_cycles_ = 0;            // cycles that begin within SystemC's time
    std::array<sc_core::sc_time, 16> delays_;  // of 0, 1, ... cycles: sc_time is slow to construct
    sc_core::sc_event tick_event_{"tick_event"};
    sc_core::sc_event quiet_{"quiet"};
    std::array<CycleProcess*, most_units> units_{};
    std::size_t attached_ = 0;
    std::array<std::uint64_t, span> due_{};  // by cycle modulo span: one bit per unit
    std::uint64_t last_due_ = 0;             // no later cycle has a bit in due_
    std::vector<Far> far_;                   // a heap, earliest first
    std::uint64_t due_now_ = 0;
    std::uint64_t cycle_ = 0;
    std::uint64_t next_tick_ = 0;
    unsigned most_ahead_ = 0;
    static constexpr unsigned cycles_between_questions = 16;
    unsigned until_asked_ = 0;      // cycles until the kernel is asked again
    std::uint64_t next_event_ = 0;  // its next event, as time after the tick
    sc_core::sc_time lag_;          // from simulated time to the beginning of the present cycle
    bool running_ = false;
    bool scheduled_ = false;
    std::uint64_t cycles_without_progress_ = 0;
    std::uint64_t most_without_progress_ = 0;
    bool halted_ = false;
    bool stalled_ = false;
    bool out_of_time_ = false;
    CycleObserver* observer_ = nullptr;
    std::uint64_t observed_first_ = 0;
    std::uint64_t observed_last_ = 0;
    bool observer_began_ = false;
};

}  // namespace tessera
