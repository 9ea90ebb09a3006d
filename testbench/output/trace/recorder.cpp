#include "testbench/output/trace/recorder.h"

#include <algorithm>
#include <array>
#include <utility>

namespace tessera {

const char* state_name(State state) {
    constexpr std::array names{"starved", "busy", "waiting for memory", "blocked"};
    static_assert(names.size() == states);
    return names.at(static_cast<std::size_t>(state));
}

namespace {

/// The name of one part; "" for a whole triangle.
const char* part_name(Parts parts) {
    constexpr std::array<const char*, 15> names = {"vertex 0", "vertex 1", "vertex 2", "normal 0", "normal 1",
                                                   "normal 2", "edge 0",   "edge 1",   "edge 2",   "edge 3",
                                                   "edge 4",   "edge 5",   "edge 6",   "edge 7",   "edge 8"};
    return parts == all_parts ? "" : names.at(static_cast<std::size_t>(__builtin_ctz(parts)));
}

}  // namespace

Recorder::Recorder(Pipeline& pipeline, VcdWriter* vcd, TimelineWriter* timeline, TraceWindow window,
                   const std::vector<const Unit*>& units)
    : pipeline_(pipeline),
      vcd_(vcd),
      timeline_(timeline),
      window_(window),
      // A randomly stalled item wakes its unit only when the stall ends, but waits at its input from the beginning.
      show_every_unit_(pipeline.random_stalls()) {
    if (vcd_ != nullptr) {
        cycle_signal_ = vcd_->add(pipeline.clock.name(), "cycle", 48);
        passes_signal_ = vcd_->add(pipeline.name(), "passes_under_way", 32);
        for (const Unit* unit : units) {
            traced_.push_back({unit, CycleScheduler::bit_of(*unit), Signals(*vcd_, numbers_, unit->name())});
            traced_.back().signals.begin(true);
            unit->trace_signals(traced_.back().signals);
        }
    }
    if (timeline_ != nullptr) {
        const std::size_t top = std::string(pipeline.name()).size() + 1;
        for (Unit* unit : pipeline.units())
            tracks_.emplace_back(*unit, *timeline_, timeline_->add_track(unit->name() + top), window.last);
    }
    pipeline.clock.observe(this, window.first, window.last);
}

Recorder::~Recorder() {
    pipeline_.clock.observe(nullptr);
    for (Track& track : tracks_)
        track.unit.activity().observe(nullptr);
}

void Recorder::Track::stretch(State state, const sc_core::sc_object* by, std::uint64_t begin, std::uint64_t end) {
    TimelineWriter::Item its_item;
    if (named)
        its_item = {item->triangle.pass, item->triangle.base, part_name(item->parts)};
    timeline.interval(number, state_name(state), by == nullptr ? "" : by->basename(), begin, end,
                      named ? &its_item : nullptr);
    if (step)
        timeline.flow(number, *step, item->triangle.pass, begin);
    step.reset();
    named = named && !unit.idle();
    if (end > last)
        unit.activity().observe(nullptr);
}

/// Records items that were begun before the window and are still in a unit.
void Recorder::enter_window() {
    culled_ = pipeline_.pass_or_tessellate.counts().culled;
    for (Track& track : tracks_) {
        track.unit.activity().observe(&track);
        const Begun begun = track.unit.begun();
        track.count = begun.count;
        track.named = begun.count > 0 && !track.unit.idle();
        if (track.named)
            track.item = begun;
    }
}

void Recorder::name_items(std::uint64_t cycle, std::uint64_t called) {
    for (Track& track : tracks_) {
        if (!show_every_unit_ && (called & CycleScheduler::bit_of(track.unit)) == 0)
            continue;
        const Begun begun = track.unit.begun();
        if (begun.count == track.count)
            continue;
        track.unit.activity().split(cycle);
        track.count = begun.count;
        const std::optional<Begun> before = std::exchange(track.item, begun);
        const FlowStep step = step_at(track);
        track.named = true;
        const std::uint32_t triangle = begun.triangle.pass;
        const bool followed = first_flow_ && triangle >= *first_flow_;
        if (followed && (!before || before->triangle.pass != triangle))
            track.step = step;
    }
}

/// The flow step of a unit that has begun a triangle.
TimelineWriter::FlowStep Recorder::step_at(const Track& track) {
    if (&track.unit == &pipeline_.get_triangle) {
        if (!first_flow_)
            first_flow_ = track.item->triangle.pass;
        return FlowStep::begin;
    }
    if (&track.unit == &pipeline_.tessellation || &track.unit == &pipeline_.lighting)
        return FlowStep::end;
    if (&track.unit != &pipeline_.pass_or_tessellate)
        return FlowStep::pass;
    const std::uint64_t culled = pipeline_.pass_or_tessellate.counts().culled;
    return std::exchange(culled_, culled) != culled ? FlowStep::end : FlowStep::pass;
}

void Recorder::show_all() {
    for (TracedUnit& traced : traced_) {
        traced.signals.begin(false);
        traced.unit->trace_signals(traced.signals);
        traced.signals.set_running();
    }
    vcd_->set(passes_signal_, pipeline_.passes_under_way());
}

void Recorder::show_queue_level(std::uint64_t cycle) {
    shown_level_ = pipeline_.triangle_queue.waiting();
    timeline_->counter("triangle_queue", "triangles waiting", cycle, shown_level_);
}

/// Records cycles in which only the cycle number changes.
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
            traced.unit->trace_signals(traced.signals);
        }
    }
    vcd_->set(passes_signal_, pipeline_.passes_under_way());
}

void Recorder::begin(std::uint64_t cycle) {
    began_ = true;
    if (vcd_ != nullptr) {
        show_all();
        next_cycle_ = window_.first;
        end_cycles_before(std::min(cycle, end_of_window()));
    }
    if (timeline_ != nullptr) {
        enter_window();
        show_queue_level(window_.first);
    }
}

void Recorder::end_of_cycle(std::uint64_t cycle, std::uint64_t called) {
    if (vcd_ != nullptr) {
        end_cycles_before(cycle);
        show_called(called);
        end_cycles_before(cycle + 1);
    }
    if (timeline_ == nullptr)
        return;
    name_items(cycle, called);
    if (pipeline_.triangle_queue.waiting() != shown_level_)
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
