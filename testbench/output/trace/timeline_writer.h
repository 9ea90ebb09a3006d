#pragma once
#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "testbench/output/trace/trace_window.h"

namespace tessera {

/// Writes what each unit did and when in the Chrome trace event format (JSON).
///
/// Use: add_track(), interval() and counter() in any order, each counter's cycles never decreasing; finish().
/// Window: intervals are cut to it, flow steps outside it left out; a counter has at its beginning the value it came in
/// with.
/// Time: microseconds, the format's unit, exact to the picosecond. Viewers add them in floating point: unless a cycle
/// is a whole number of microseconds, neighbours overlap by a rounding error, and are shown as nested or not at all.
/// Colours: hints; some viewers colour by name instead. So a state, always in the same words, is the name, and the
/// detail an argument. The file holds nothing that differs between equal runs.
/// Whether the stream took the bytes is the caller's to check. Misuse is a std::logic_error.
class TimelineWriter {
  public:
    using Track = std::uint32_t;

    /// What an interval is about: a triangle, the base triangle it descends from, and which part of it if not the
    /// whole.
    struct Item {
        std::uint64_t triangle = 0;
        std::uint64_t base = 0;
        std::string_view part;
    };
    /// A flow's way: where it begins, what it passes and where it ends.
    enum class FlowStep : std::uint8_t { begin, pass, end };

    TimelineWriter(std::ostream& out, std::uint64_t cycle_picoseconds, TraceWindow window = {});
    TimelineWriter(const TimelineWriter&) = delete;
    TimelineWriter& operator=(const TimelineWriter&) = delete;

    /// Tracks are shown in the order they were added in.
    Track add_track(const std::string& name);

    /// The track is in `state` from the beginning of cycle `begin` to that of `end`. Known states have colours of their
    /// own: "busy", "blocked", "waiting for memory", "starved". detail: "", or for instance who blocks.
    /// item: null: none.
    void interval(Track track, const char* state, const char* detail, std::uint64_t begin, std::uint64_t end,
                  const Item* item = nullptr);

    /// Flow `triangle` comes to the track's interval that begins at `cycle`, to be called after that. Viewers draw an
    /// arrow from each step to the next. The time is half a cycle later, so that no viewer takes the interval that ends
    /// at `cycle`.
    void flow(Track track, FlowStep step, std::uint64_t triangle, std::uint64_t cycle);

    /// The series' value from `cycle` on. chrome://tracing shows a name's first series only, Perfetto each.
    void counter(const char* name, const char* series, std::uint64_t cycle, std::uint64_t value);

    void finish();

  private:
    void check_open() const;
    void write_counter(std::string_view name, std::string_view series, std::uint64_t cycle, std::uint64_t value);
    void write(std::string_view event);

    std::ostream& out_;
    std::uint64_t cycle_picoseconds_;
    TraceWindow window_;
    Track tracks_ = 0;
    // Counters' values before the window: name and series to value.
    std::map<std::pair<std::string, std::string>, std::uint64_t> held_;
    bool reached_ = false;  // the window
    bool finished_ = false;
    std::string buffer_;
};

}  // namespace tessera
