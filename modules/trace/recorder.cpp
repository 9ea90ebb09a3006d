#include "modules/trace/recorder.h"

#include <algorithm>

namespace tessera {

const char* state_name(State state) {
    switch (state) {
        case State::starved:
            return "starved";
        case State::busy:
            return "busy";
        case State::waiting_for_memory:
            return "waiting for memory";
        case State::blocked:
            return "blocked";
    }
    return "";
}

Recorder::Recorder(Pipeline& pipeline, VcdWriter* vcd, TimelineWriter* timeline, TraceWindow window,
                   const std::vector<const Unit*>& units)
    : pipeline_(pipeline),
      vcd_(vcd),
      timeline_(timeline),
      window_(window),
      // An item held back at random calls its unit only when its time has come, but stands at the door at once.
      show_every_unit_(pipeline.random_stalls()) {
    if (vcd_ != nullptr) {
        cycle_signal_ = vcd_->add(pipeline.clock.name(), "cycle", 48);
        passes_signal_ = vcd_->add(pipeline.name(), "passes_under_way", 32);
        for (const Unit* unit : units) {
            traced_.push_back({unit, Clock::bit_of(*unit), Signals(*vcd_, numbers_, unit->name())});
            traced_.back().signals.begin(true);
            unit->show(traced_.back().signals);
        }
    }
    if (timeline_ != nullptr) {
        const std::size_t top = std::string(pipeline.name()).size() + 1;
        for (Unit* unit : pipeline.units())
            tracks_.emplace_back(unit->activity(), *timeline_, timeline_->add_track(unit->name() + top),
                                 window.last);
    }
    pipeline.clock.observe(this, window.first, window.last);
}

Recorder::~Recorder() {
    pipeline_.clock.observe(nullptr);
    for (Track& track : tracks_)
        track.activity.observe(nullptr);
}

void Recorder::Track::stretch(State state, const sc_core::sc_object* by, std::uint64_t begin,
                              std::uint64_t end) {
    timeline.interval(number, state_name(state), by == nullptr ? "" : by->basename(), begin, end);
    if (end > last)
        activity.observe(nullptr);
}

void Recorder::show_all() {
    for (TracedUnit& traced : traced_) {
        traced.signals.begin(false);
        traced.unit->show(traced.signals);
        traced.signals.set_running();
    }
    vcd_->set(passes_signal_, pipeline_.passes.under_way());
}

void Recorder::show_queue_level(std::uint64_t cycle) {
    shown_level_ = pipeline_.triangle_queue.waiting();
    timeline_->counter("triangle_queue", "triangles waiting", cycle, shown_level_);
}

/// Cycles that show nothing new but their number.
void Recorder::end_cycles_before(std::uint64_t cycle) {
    for (; next_cycle_ < cycle; ++next_cycle_) {
        vcd_->set(cycle_signal_, next_cycle_);
        vcd_->end_cycle(next_cycle_);
    }
}

void Recorder::show_called(std::uint64_t called) {
    if (show_every_unit_)
        called = ~std::uint64_t{0};
    for (TracedUnit& traced : traced_) {
        if ((called & traced.bit) != 0) {
            traced.signals.begin(false);
            traced.unit->show(traced.signals);
        }
    }
    vcd_->set(passes_signal_, pipeline_.passes.under_way());
}

void Recorder::begin(std::uint64_t cycle) {
    began_ = true;
    if (vcd_ != nullptr) {
        show_all();
        next_cycle_ = window_.first;
        end_cycles_before(std::min(cycle, end_of_window()));
    }
    if (timeline_ != nullptr) {
        for (Track& track : tracks_)
            track.activity.observe(&track);
        show_queue_level(window_.first);
    }
}

void Recorder::end_of_cycle(std::uint64_t cycle, std::uint64_t called) {
    if (vcd_ != nullptr) {
        end_cycles_before(cycle);
        show_called(called);
        end_cycles_before(cycle + 1);
    }
    if (timeline_ != nullptr && pipeline_.triangle_queue.waiting() != shown_level_)
        show_queue_level(cycle);
}

void Recorder::finish(std::uint64_t cycles) {
    if (vcd_ != nullptr) {
        if (!began_) {
            show_all();
            next_cycle_ = cycles - 1;
        }
        end_cycles_before(began_ ? std::min(cycles, end_of_window()) : cycles);
        vcd_->finish(cycles);
    }
    if (timeline_ != nullptr)
        timeline_->finish();
}

}  // namespace tessera
