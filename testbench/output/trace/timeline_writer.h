#pragma once
#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "testbench/output/trace/trace_window.h"

namespace tessera {

/// Writes the activity of each unit over time in the Chrome trace event format (JSON).
///
/// Use: add_track(), interval() and counter() in any order, each counter's cycles never decreasing; finish().
/// Window: intervals are clipped to it, flow steps outside are omitted; a counter begins with its value at the window's
/// start.
/// Time: microseconds, the format's unit, exact to the picosecond. Viewers add times in floating point: unless a cycle
/// is a whole number of microseconds, neighbours overlap by a rounding error, and are shown as nested or not at all.
/// Colours: hints; some viewers colour by name instead. So the name is a state, always in the same words, and details
/// are arguments. Equal runs give equal files. The caller must check the stream's state. Misuse throws
/// std::logic_error.
class TimelineWriter {
  public:
    using Track = std::uint32_t;

    /// The subject of an interval: a triangle, its base triangle, and which part of it unless the whole.
    struct Item {
        std::uint64_t triangle = 0;
        std::uint64_t base = 0;
        std::string_view part;
    };
    /// The step of a flow: its beginning, a passage or its end.
    enum class FlowStep : std::uint8_t { begin, pass, end };

    TimelineWriter(std::ostream& out, std::uint64_t cycle_picoseconds, TraceWindow window = {});
    TimelineWriter(const TimelineWriter&) = delete;
    TimelineWriter& operator=(const TimelineWriter&) = delete;

    /// Adds a track; tracks are shown in the order of addition.
    Track add_track(const std::string& name);

    /// The track is in `state` from the beginning of cycle `begin` to that of `end`. Known states have their own
    /// colours: "busy", "blocked", "waiting for memory", "starved". detail: "", or for instance the blocking unit.
    /// item: may be null.
    void interval(Track track, const char* state, const char* detail, std::uint64_t begin, std::uint64_t end,
                  const Item* item = nullptr);

    /// Adds a step of flow `triangle` at the track's interval that begins at `cycle`; call after interval(). Viewers
    /// draw an arrow from each step to the next. The time is half a cycle later, so that viewers do not choose the
    /// interval that ends at `cycle`.
    void flow(Track track, FlowStep step, std::uint64_t triangle, std::uint64_t cycle);

    /// Sets the series' value from `cycle` on. chrome://tracing shows only the first series of a name, Perfetto all.
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
    bool reached_ = false;  // the window has been reached
    bool finished_ = false;
    std::string buffer_;
};

}  // namespace tessera
