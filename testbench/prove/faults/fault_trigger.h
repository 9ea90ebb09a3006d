#pragma once
#include <cstdint>
#include <systemc>

#include "testbench/job/job.h"

namespace tessera {

/// One fault of a run: counts what it may strike, says when it is to, and remembers that it did.
class FaultTrigger {
  public:
    /// cycle_picoseconds: the clock's period.
    FaultTrigger(const Job::Fault& fault, unsigned cycle_picoseconds)
        : fault_(fault), period_(cycle_picoseconds, sc_core::SC_PS) {}

    FaultKind kind() const { return fault_.kind; }
    std::uint64_t bit() const { return static_cast<std::uint64_t>(fault_.bit); }

    /// A transaction comes by that the fault's kind can strike. True: this is the one.
    bool strikes() {
        ++seen_;
        if (disarmed_ || seen_ != static_cast<std::uint64_t>(fault_.transaction))
            return false;
        injected_ = true;
        cycle_ = static_cast<std::uint64_t>(sc_core::sc_time_stamp() / period_);
        return true;
    }
    /// No transaction is the one any more: the machine as it stands, without its fault.
    void disarm() { disarmed_ = true; }
    /// The broken transaction is kept until the next has gone, or has now been sent.
    void waits_for_next(bool waits) { waits_for_next_ = waits; }
    /// The bit to be flipped does not exist.
    void has_no_such_bit() { no_such_bit_ = true; }

    bool injected() const { return injected_; }
    bool no_such_bit() const { return no_such_bit_; }
    bool waits_for_next() const { return waits_for_next_; }
    std::uint64_t seen() const { return seen_; }
    /// In which it was injected; timed mode.
    std::uint64_t cycle() const { return cycle_; }

  private:
    Job::Fault fault_;
    sc_core::sc_time period_;
    std::uint64_t seen_ = 0;
    std::uint64_t cycle_ = 0;
    bool disarmed_ = false;
    bool injected_ = false;
    bool waits_for_next_ = false;
    bool no_such_bit_ = false;
};

}  // namespace tessera
