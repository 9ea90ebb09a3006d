#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <systemc>
#include <vector>

#include "modules/pipeline.h"
#include "modules/stage/signals.h"
#include "modules/timing/activity.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/unit_numbers.h"
#include "testbench/output/trace/timeline_writer.h"
#include "testbench/output/trace/trace_window.h"
#include "testbench/output/trace/vcd_writer.h"

namespace tessera {

/// Records a pipeline in timed mode with the writers of waveforms and of the timeline, each optional.
///
/// Waveforms: the signals of the selected units (Unit::trace_signals), at the end of each cycle in which they were
/// called; and the cycle (tessera.clock.cycle) and the number of passes in flight. Timeline: a track per unit with its
/// states, the unit that blocks it, what it waits for or lacks, and the item it last began; the Triangle Queue's level.
/// A flow connects, in chronological order, the intervals in which each unit began a triangle: from Get Triangle to
/// Tessellation, to Lighting, or if it is culled to Pass or Tessellate. Outside the window there is no cost, since
/// clock and units are not observed. Recording does not affect the simulation.
class Recorder : public CycleObserver {
  public:
    /// Call before the simulation begins. vcd, timeline: may be null; their windows are this one. units: those whose
    /// signals are recorded.
    Recorder(Pipeline& pipeline, VcdWriter* vcd, TimelineWriter* timeline, TraceWindow window,
             const std::vector<const Unit*>& units);
    ~Recorder() override;

    /// Call after the run and the units' Activity::finish. `cycles`: length of the run, at least 1.
    void finish(std::uint64_t cycles);

  private:
    struct TracedUnit {
        const Unit* unit;
        std::uint64_t bit;
        Signals signals;
    };
    using FlowStep = TimelineWriter::FlowStep;
    /// Forwards a unit's intervals, up to the one that reaches the window's end.
    struct Track : ActivityObserver {
        Track(Unit& its_unit, TimelineWriter& its_timeline, TimelineWriter::Track its_number, std::uint64_t last_cycle)
            : unit(its_unit), timeline(its_timeline), number(its_number), last(last_cycle) {}
        void stretch(State state, const sc_core::sc_object* by, std::uint64_t begin, std::uint64_t end) override;

        Unit& unit;
        TimelineWriter& timeline;
        TimelineWriter::Track number;
        std::uint64_t last;
        std::uint64_t count = 0;       // items begun
        std::optional<Begun> item;     // the last of them, if known
        bool named = false;            // the current interval refers to it
        std::optional<FlowStep> step;  // and this is its flow step there
    };

    void begin(std::uint64_t cycle) override;
    void end_of_cycle(std::uint64_t cycle, std::uint64_t called) override;
    void show_all();
    void show_called(std::uint64_t called);
    void end_cycles_before(std::uint64_t cycle);
    std::uint64_t end_of_window() const { return window_.last == UINT64_MAX ? window_.last : window_.last + 1; }
    void show_queue_level(std::uint64_t cycle);
    void enter_window();
    void name_items(std::uint64_t cycle, std::uint64_t called);
    FlowStep step_at(const Track& track);

    Pipeline& pipeline_;
    VcdWriter* vcd_;
    TimelineWriter* timeline_;
    TraceWindow window_;
    bool show_every_unit_;
    UnitNumbers numbers_{numbered_units()};
    VcdWriter::Signal cycle_signal_ = 0;
    VcdWriter::Signal passes_signal_ = 0;
    std::vector<TracedUnit> traced_;
    std::deque<Track> tracks_;
    std::uint64_t culled_ = 0;
    std::optional<std::uint32_t> first_flow_;  // earlier triangles were in flight when the window began
    std::size_t shown_level_ = 0;
    bool began_ = false;
    std::uint64_t next_cycle_ = 0;  // the first cycle with incomplete waveforms
};

/// Text used in the timeline and in waveforms/states.txt: "busy", "waiting for memory", ...
const char* state_name(State state);

}  // namespace tessera
