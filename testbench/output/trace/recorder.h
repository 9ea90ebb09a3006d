#pragma once
#include <cstdint>
#include <vector>

#include "modules/machine.h"
#include "modules/stage/signals.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/unit_numbers.h"
#include "testbench/output/trace/trace_window.h"
#include "testbench/output/trace/vcd_writer.h"

namespace tessera {

/// Records a pipeline in timed mode: the signals of the selected units (Unit::trace_signals), at the end of each cycle in
/// which they were called; and the cycle (tessera.clock.cycle) and the number of passes in flight. Outside the window
/// there is no cost, since the clock is not observed. Recording does not affect the simulation.
class Recorder : public CycleObserver {
  public:
    /// Call before the simulation begins. window: that of `vcd`. units: those whose signals are recorded.
    Recorder(Machine& machine, VcdWriter& vcd, TraceWindow window, const std::vector<const Unit*>& units);
    ~Recorder() override;

    /// Call after the run and the units' Activity::finish. `cycles`: length of the run, at least 1.
    void finish(std::uint64_t cycles);

  private:
    struct TracedUnit {
        const Unit* unit;
        std::uint64_t bit;
        Signals signals;
    };

    void begin(std::uint64_t cycle) override;
    void end_of_cycle(std::uint64_t cycle, std::uint64_t called) override;
    void show_all();
    void show_called(std::uint64_t called);
    void end_cycles_before(std::uint64_t cycle);
    std::uint64_t end_of_window() const { return window_.last == UINT64_MAX ? window_.last : window_.last + 1; }

    Machine& machine_;
    VcdWriter& vcd_;
    TraceWindow window_;
    bool show_every_unit_;
    UnitNumbers numbers_{numbered_units()};
    VcdWriter::Signal cycle_signal_, passes_signal_;
    std::vector<TracedUnit> traced_;
    bool began_ = false;
    std::uint64_t next_cycle_ = 0;  // the first cycle with incomplete waveforms
};

}  // namespace tessera
