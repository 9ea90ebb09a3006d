#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <systemc>

#include "modules/datapath/format.h"
#include "modules/stage/area.h"
#include "modules/timing/activity.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/timing/design.h"

namespace tessera {

class Signals;

/// A box of the paper's figures 7 and 8, or a memory: a clocked module that records its state in each cycle.
class Unit : public CycleProcess, public sc_core::sc_module {
  public:
    const Activity& activity() const { return activity_; }
    Activity& activity() { return activity_; }

    /// For the deadlock report: the items in the unit and at its inputs, in words; an empty string if there are none.
    virtual std::string describe_contents() const = 0;

    /// Cycles that the unit's work occupies at its initiation interval or, for a memory, at its ports.
    virtual std::uint64_t occupied_cycles() const = 0;

    /// For the design and the registers with which the machine was built: what frames switch on later (culling, the
    /// Highlight Test) is not counted.
    const Area& area() const { return area_; }

    /// Values that its arithmetic has saturated.
    const datapath::Saturations& saturations() const { return saturations_; }

    bool idle() const { return activity_.level() == 0; }

    /// Declares the unit's signals, or shows their values at the end of a cycle (modules/stage/signals.h). For every
    /// unit: its state, the unit that blocks it or that it waits for, and the items in it.
    virtual void trace_signals(Signals& signals) const;

  protected:
    Unit(const sc_core::sc_module_name& name, CycleScheduler& clock) : sc_module(name), clock_(clock) {}

    std::uint64_t now() const { return clock_.cycle(); }
    // Called in every step; without the attribute gcc does not inline it there.
    [[gnu::always_inline]] void wake_at(std::uint64_t cycle) {
        if (cycle != ~std::uint64_t{0})
            clock_.wake_at(*this, cycle);
    }

    CycleScheduler& clock_;
    Activity activity_;
    Area area_;  // of a table set by Machine, else in the constructor
    datapath::Saturations saturations_;
};

/// occupied_cycles() of a unit that holds one item at a time and sends it on in parts: the first a latency after its
/// arrival, each at least an interval after the last.
constexpr std::uint64_t one_at_a_time_cycles(const UnitTiming& timing, std::uint64_t items, std::uint64_t parts) {
    const std::uint64_t first = timing.latency > timing.interval ? timing.latency : timing.interval;
    return items * first + (parts - items) * timing.interval;
}

/// "3 edges", "1 edge", "".
std::string count_of(std::size_t count, const char* what);

/// Both, with the separator between them where neither is empty.
std::string listed(const std::string& text, const std::string& more, const char* separator = ", ");

}  // namespace tessera
