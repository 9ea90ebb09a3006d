#include "testbench/output/trace/timeline_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <ostream>
#include <stdexcept>
#include <utility>

namespace tessera {
namespace {

constexpr std::size_t flush_bytes = std::size_t{1} << 16;

struct Colour {
    std::string_view state;
    const char* name;
};

// chrome://tracing knows colours by these names only (color_scheme.html has them all): green, red, yellow, light grey;
// dark grey.
constexpr std::array<Colour, 4> state_colours = {
    {{"busy", "good"}, {"blocked", "terrible"}, {"waiting for memory", "yellow"}, {"starved", "grey"}}};
constexpr const char* other_colour = "generic_work";

const char* colour_of(std::string_view state) {
    const auto* const known = std::find_if(state_colours.begin(), state_colours.end(),
                                           [&](const Colour& colour) { return colour.state == state; });
    return known != state_colours.end() ? known->name : other_colour;
}

}  // namespace

TimelineWriter::TimelineWriter(std::ostream& out, std::uint64_t cycle_picoseconds, TraceWindow window)
    : out_(out), cycle_picoseconds_(cycle_picoseconds), window_(window) {
    if (cycle_picoseconds == 0)
        throw std::logic_error("TimelineWriter: a clock without period");
    buffer_.reserve(2 * flush_bytes);
    buffer_ = R"({"displayTimeUnit":"ns","traceEvents":[
{"ph":"M","pid":1,"name":"process_name","args":{"name":"tessera"}})";
}

TimelineWriter::Track TimelineWriter::add_track(const std::string& name) {
    check_open();
    const Track track = tracks_++;
    begin_event("M", "thread_name");
    buffer_ += ",\"tid\":";
    write_number(track + 1);
    buffer_ += ",\"args\":{\"name\":";
    write_string(name);
    buffer_ += '}';
    end_event();
    begin_event("M", "thread_sort_index");
    buffer_ += ",\"tid\":";
    write_number(track + 1);
    buffer_ += ",\"args\":{\"sort_index\":";
    write_number(track);
    buffer_ += '}';
    end_event();
    return track;
}

void TimelineWriter::interval(Track track, const char* state, const char* detail, std::uint64_t begin,
                              std::uint64_t end, const Item* item) {
    check_open();
    if (track >= tracks_)
        throw std::logic_error("TimelineWriter: an interval of no track");
    reached_ = reached_ || end > window_.first;
    begin = std::max(begin, window_.first);
    end = end <= window_.last ? end : window_.last + 1;
    if (begin >= end)
        return;
    begin_event("X", state);
    buffer_ += ",\"tid\":";
    write_number(track + 1);
    buffer_ += ",\"ts\":";
    write_microseconds(begin);
    buffer_ += ",\"dur\":";
    write_microseconds(end - begin);
    buffer_ += ",\"cname\":\"";
    buffer_ += colour_of(state);
    buffer_ += '"';
    if (item != nullptr || *detail != '\0')
        write_arguments(detail, item);
    end_event();
}

void TimelineWriter::write_arguments(std::string_view detail, const Item* item) {
    const char* before = ",\"args\":{";
    const auto name = [&](const char* of) {
        buffer_ += std::exchange(before, ",");
        buffer_ += of;
    };
    if (!detail.empty()) {
        name("\"detail\":");
        write_string(detail);
    }
    if (item != nullptr) {
        name("\"triangle\":");
        write_number(item->triangle);
        if (!item->part.empty()) {
            name("\"part\":");
            write_string(item->part);
        }
        name("\"base\":");
        write_number(item->base);
    }
    buffer_ += '}';
}

void TimelineWriter::flow(Track track, FlowStep step, std::uint64_t triangle, std::uint64_t cycle) {
    check_open();
    if (track >= tracks_)
        throw std::logic_error("TimelineWriter: a flow through no track");
    if (cycle < window_.first || cycle > window_.last)
        return;
    begin_event(step == FlowStep::begin ? "s" : step == FlowStep::pass ? "t" : "f", "triangle");
    buffer_ += ",\"cat\":\"triangle\",\"id\":";
    write_number(triangle);
    buffer_ += ",\"tid\":";
    write_number(track + 1);
    buffer_ += ",\"ts\":";
    write_time(cycle * cycle_picoseconds_ + cycle_picoseconds_ / 2);
    if (step == FlowStep::end)
        buffer_ += ",\"bp\":\"e\"";
    end_event();
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
    if (reached_) {
        for (const auto& [counter, value] : held_)
            write_counter(counter.first, counter.second, window_.first, value);
    }
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
    begin_event("C", name);
    buffer_ += ",\"ts\":";
    write_microseconds(cycle);
    buffer_ += ",\"args\":{";
    write_string(series);
    buffer_ += ':';
    write_number(value);
    buffer_ += '}';
    end_event();
}

void TimelineWriter::begin_event(const char* phase, std::string_view name) {
    buffer_ += ",\n{\"ph\":\"";
    buffer_ += phase;
    buffer_ += "\",\"pid\":1,\"name\":";
    write_string(name);
}

void TimelineWriter::end_event() {
    buffer_ += '}';
    if (buffer_.size() >= flush_bytes) {
        out_ << buffer_;
        buffer_.clear();
    }
}

void TimelineWriter::write_string(std::string_view text) {
    constexpr std::string_view hex = "0123456789abcdef";
    buffer_ += '"';
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            buffer_ += '\\';
            buffer_ += c;
        } else if (code < 0x20) {
            buffer_ += "\\u00";
            buffer_ += hex[code >> 4];
            buffer_ += hex[code & 15];
        } else {
            buffer_ += c;
        }
    }
    buffer_ += '"';
}

void TimelineWriter::write_number(std::uint64_t number) {
    std::array<char, 20> digits;
    buffer_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
}

/// In microseconds.
void TimelineWriter::write_time(std::uint64_t picoseconds) {
    constexpr std::uint64_t microsecond = 1'000'000;
    write_number(picoseconds / microsecond);
    std::array<char, 7> digits{'.'};
    std::size_t used = 0;
    std::uint64_t rest = picoseconds % microsecond;
    for (std::size_t place = 6; place > 0; --place, rest /= 10) {
        digits[place] = static_cast<char>('0' + rest % 10);
        if (used == 0 && digits[place] != '0')
            used = place + 1;
    }
    buffer_.append(digits.data(), used);
}

}  // namespace tessera
