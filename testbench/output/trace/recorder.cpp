#include "testbench/output/trace/recorder.h"

#include <algorithm>

namespace tessera {

Recorder::Recorder(Machine& machine, VcdWriter& vcd, TraceWindow window, const std::vector<const Unit*>& units)
    : machine_(machine),
      vcd_(vcd),
      window_(window),
      // A randomly stalled item wakes its unit only when the stall ends, but waits at its input from the beginning.
      show_every_unit_(machine.random_stalls()),
      cycle_signal_(vcd.add(machine.clock.name(), "cycle", 48)),
      passes_signal_(vcd.add(machine.name(), "passes_under_way", 32)) {
    for (const Unit* unit : units) {
        traced_.push_back({unit, CycleScheduler::bit_of(*unit), Signals(vcd, numbers_, unit->name())});
        traced_.back().signals.begin(true);
        unit->trace_signals(traced_.back().signals);
    }
    machine.clock.observe(this, window.first, window.last);
}

Recorder::~Recorder() {
    machine_.clock.observe(nullptr);
}

void Recorder::show_all() {
    for (TracedUnit& traced : traced_) {
        traced.signals.begin(false);
        traced.unit->trace_signals(traced.signals);
        traced.signals.set_running();
    }
    vcd_.set(passes_signal_, machine_.passes_under_way());
}

/// Records cycles in which only the cycle number changes.
void Recorder::end_cycles_before(std::uint64_t cycle) {
    for (; next_cycle_ < cycle; ++next_cycle_) {
        vcd_.set(cycle_signal_, next_cycle_);
        vcd_.end_cycle(next_cycle_);
    }
}

void Recorder::show_called(std::uint64_t called) {
    if (show_every_unit_)
        called = ~std::uint64_t{0};
    for (TracedUnit& traced : traced_) {
        if ((called & traced.bit) != 0) {
            traced.signals.begin(false);
            traced.unit->trace_signals(traced.signals);
        }
    }
    vcd_.set(passes_signal_, machine_.passes_under_way());
}

void Recorder::begin(std::uint64_t cycle) {
    began_ = true;
    show_all();
    next_cycle_ = window_.first;
    end_cycles_before(std::min(cycle, end_of_window()));
}

void Recorder::end_of_cycle(std::uint64_t cycle, std::uint64_t called) {
    end_cycles_before(cycle);
    show_called(called);
    end_cycles_before(cycle + 1);
}

void Recorder::finish(std::uint64_t cycles) {
    if (!began_) {
        show_all();
        next_cycle_ = cycles - 1;
    }
    end_cycles_before(began_ ? std::min(cycles, end_of_window()) : cycles);
    vcd_.finish(cycles);
}

}  // namespace tessera
