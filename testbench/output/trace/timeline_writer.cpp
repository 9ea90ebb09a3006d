#include "testbench/output/trace/timeline_writer.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

namespace tessera {
namespace {

constexpr std::size_t flush_bytes = std::size_t{1} << 16;

struct Colour {
    std::string_view state;
    const char* name;
};

// chrome://tracing accepts only these colour names (all are in color_scheme.html): green, red, yellow, light grey; dark
// grey.
constexpr std::array<Colour, 4> state_colours = {
    {{"busy", "good"}, {"blocked", "terrible"}, {"waiting for memory", "yellow"}, {"starved", "grey"}}};
constexpr const char* other_colour = "generic_work";

const char* colour_of(std::string_view state) {
    const auto* const known = std::find_if(state_colours.begin(), state_colours.end(),
                                           [&](const Colour& colour) { return colour.state == state; });
    return known != state_colours.end() ? known->name : other_colour;
}

std::string json_string(std::string_view text) {
    return nlohmann::json(text).dump();
}

std::string microseconds(std::uint64_t picoseconds) {
    std::string text = fmt::format("{}.{:06}", picoseconds / 1'000'000, picoseconds % 1'000'000);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.')
        text.pop_back();
    return text;
}

/// The member "args" of an interval, with a leading comma; "" if there are none.
std::string arguments(std::string_view detail, const TimelineWriter::Item* item) {
    std::string members;
    if (!detail.empty())
        members += fmt::format(R"(,"detail":{})", json_string(detail));
    if (item != nullptr) {
        members += fmt::format(R"(,"triangle":{})", item->triangle);
        if (!item->part.empty())
            members += fmt::format(R"(,"part":{})", json_string(item->part));
        members += fmt::format(R"(,"base":{})", item->base);
    }
    return members.empty() ? "" : fmt::format(R"(,"args":{{{}}})", members.substr(1));
}

}  // namespace

TimelineWriter::TimelineWriter(std::ostream& out, std::uint64_t cycle_picoseconds, TraceWindow window)
    : out_(out), cycle_picoseconds_(cycle_picoseconds), window_(window) {
    if (cycle_picoseconds == 0)
        throw std::logic_error("TimelineWriter: the clock has no period");
    buffer_.reserve(2 * flush_bytes);
    buffer_ = R"({"displayTimeUnit":"ns","traceEvents":[
{"ph":"M","pid":1,"name":"process_name","args":{"name":"tessera"}})";
}

TimelineWriter::Track TimelineWriter::add_track(const std::string& name) {
    check_open();
    const Track track = tracks_++;
    write(fmt::format(R"({{"ph":"M","pid":1,"name":"thread_name","tid":{},"args":{{"name":{}}}}})", track + 1,
                      json_string(name)));
    write(fmt::format(R"({{"ph":"M","pid":1,"name":"thread_sort_index","tid":{},"args":{{"sort_index":{}}}}})",
                      track + 1, track));
    return track;
}

void TimelineWriter::interval(Track track, const char* state, const char* detail, std::uint64_t begin,
                              std::uint64_t end, const Item* item) {
    check_open();
    if (track >= tracks_)
        throw std::logic_error("TimelineWriter: an interval without a track");
    reached_ = reached_ || end > window_.first;
    begin = std::max(begin, window_.first);
    end = end <= window_.last ? end : window_.last + 1;
    if (begin >= end)
        return;
    write(fmt::format(R"({{"ph":"X","pid":1,"name":{},"tid":{},"ts":{},"dur":{},"cname":"{}"{}}})", json_string(state),
                      track + 1, microseconds(begin * cycle_picoseconds_),
                      microseconds((end - begin) * cycle_picoseconds_), colour_of(state), arguments(detail, item)));
}

void TimelineWriter::flow(Track track, FlowStep step, std::uint64_t triangle, std::uint64_t cycle) {
    check_open();
    if (track >= tracks_)
        throw std::logic_error("TimelineWriter: a flow without a track");
    if (cycle < window_.first || cycle > window_.last)
        return;
    const char* const phase = step == FlowStep::begin ? "s" : step == FlowStep::pass ? "t" : "f";
    write(fmt::format(R"({{"ph":"{}","pid":1,"name":"triangle","cat":"triangle","id":{},"tid":{},"ts":{}{}}})", phase,
                      triangle, track + 1, microseconds(cycle * cycle_picoseconds_ + cycle_picoseconds_ / 2),
                      step == FlowStep::end ? R"(,"bp":"e")" : ""));
}

void TimelineWriter::counter(const char* name, const char* series, std::uint64_t cycle, std::uint64_t value) {
    check_open();
    if (cycle < window_.first) {
        held_[{name, series}] = value;
        return;
    }
    reached_ = true;
    if (!held_.empty()) {
        const auto held = held_.find({name, series});
        if (held != held_.end()) {
            if (cycle > window_.first)
                write_counter(name, series, window_.first, held->second);
            held_.erase(held);
        }
    }
    write_counter(name, series, cycle, value);
}

void TimelineWriter::finish() {
    check_open();
    if (reached_)
        for (const auto& [counter, value] : held_)
            write_counter(counter.first, counter.second, window_.first, value);
    buffer_ += "\n]}\n";
    out_ << buffer_;
    out_.flush();
    finished_ = true;
}

void TimelineWriter::check_open() const {
    if (finished_)
        throw std::logic_error("TimelineWriter: used after finish()");
}

void TimelineWriter::write_counter(std::string_view name, std::string_view series, std::uint64_t cycle,
                                   std::uint64_t value) {
    if (cycle > window_.last)
        return;
    write(fmt::format(R"({{"ph":"C","pid":1,"name":{},"ts":{},"args":{{{}:{}}}}})", json_string(name),
                      microseconds(cycle * cycle_picoseconds_), json_string(series), value));
}

void TimelineWriter::write(std::string_view event) {
    buffer_ += ",\n";
    buffer_ += event;
    if (buffer_.size() >= flush_bytes) {
        out_ << buffer_;
        buffer_.clear();
    }
}

}  // namespace tessera
