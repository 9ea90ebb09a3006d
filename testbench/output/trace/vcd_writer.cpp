#include "testbench/output/trace/vcd_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <ostream>
#include <stdexcept>

namespace tessera {
namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 18;
// A time stamp and a change, and the bytes copied beyond their ends.
constexpr std::size_t longest_entry = 128;

constexpr std::array<std::array<char, 8>, 256> make_bytes_in_binary() {
    std::array<std::array<char, 8>, 256> table{};
    for (unsigned byte = 0; byte < 256; ++byte)
        for (unsigned bit = 0; bit < 8; ++bit)
            table[byte][7 - bit] = (byte >> bit & 1) != 0 ? '1' : '0';
    return table;
}
constexpr auto bytes_in_binary = make_bytes_in_binary();

bool is_identifier(const std::string& name) {
    return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
}

/// Short and printable; VCD allows '!' to '~'.
std::string make_code(VcdWriter::Signal signal) {
    constexpr VcdWriter::Signal digits = '~' - '!' + 1;
    std::string code;
    do {
        code += static_cast<char>('!' + signal % digits);
        signal /= digits;
    } while (signal-- != 0);
    return code;
}

}  // namespace

VcdWriter::VcdWriter(std::ostream& out, std::uint64_t cycle_picoseconds, TraceWindow window)
    : out_(out), window_(window), cycle_units_(cycle_picoseconds), buffer_(buffer_bytes) {
    if (cycle_picoseconds == 0)
        throw std::logic_error("VcdWriter: the clock has no period");
    constexpr std::array<const char*, 5> units = {"ps", "ns", "us", "ms", "s"};
    std::size_t power = 0;
    for (; cycle_units_ % 10 == 0 && power + 1 < 3 * units.size(); ++power)
        cycle_units_ /= 10;
    timescale_ = "1" + std::string(power % 3, '0') + units[power / 3];
}

VcdWriter::Signal VcdWriter::add(const std::string& scope, const std::string& name, unsigned bits) {
    const std::string both = scope + "." + name;
    if (header_written_)
        throw std::logic_error("VcdWriter: " + both + " was added after the first cycle");
    if (bits < 1 || bits > 64 || !is_identifier(name))
        throw std::logic_error("VcdWriter: " + both + " needs 1 to 64 bits and a name that VCD allows");
    std::vector<Variable>& variables = scopes_[find_scope(scope)].variables;
    if (std::any_of(variables.begin(), variables.end(), [&](const Variable& v) { return v.name == name; }))
        throw std::logic_error("VcdWriter: " + both + " was already added");

    const auto signal = static_cast<Signal>(wires_.size());
    const std::string tail = (bits == 1 ? "" : " ") + make_code(signal) + "\n";
    Wire wire;
    wire.mask = UINT64_MAX >> (64 - bits);
    wire.tail_length = static_cast<std::uint8_t>(tail.copy(wire.tail, sizeof wire.tail));
    wires_.push_back(wire);
    changed_.push_back(signal);
    variables.push_back({name, bits, signal});
    return signal;
}

std::size_t VcdWriter::find_scope(const std::string& path) {
    std::size_t scope = 0;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string name = path.substr(begin, end - begin);
        if (!is_identifier(name))
            throw std::logic_error("VcdWriter: VCD does not allow the scope \"" + path + "\"");
        const std::vector<std::size_t>& known = scopes_[scope].scopes;
        const auto found =
            std::find_if(known.begin(), known.end(), [&](std::size_t s) { return scopes_[s].name == name; });
        if (found != known.end()) {
            scope = *found;
        } else {
            scopes_[scope].scopes.push_back(scopes_.size());
            scope = scopes_.size();
            scopes_.push_back({name, {}, {}});
        }
        begin = end + 1;
    }
    return scope;
}

void VcdWriter::write_header() {
    std::string text = "$version tessera $end\n$timescale " + timescale_ + " $end\n";
    write_scope(scopes_[0], text);
    text += "$enddefinitions $end\n";
    out_.write(text.data(), static_cast<std::streamsize>(text.size()));
    header_written_ = true;
}

void VcdWriter::write_scope(const Scope& scope, std::string& text) const {
    for (const Variable& variable : scope.variables) {
        text += "$var wire " + std::to_string(variable.bits) + " " + make_code(variable.signal) + " " + variable.name;
        text += variable.bits == 1 ? " $end\n" : " [" + std::to_string(variable.bits - 1) + ":0] $end\n";
    }
    for (const std::size_t inner : scope.scopes) {
        text += "$scope module " + scopes_[inner].name + " $end\n";
        write_scope(scopes_[inner], text);
        text += "$upscope $end\n";
    }
}

void VcdWriter::end_cycle(std::uint64_t cycle) {
    if (finished_ || cycle < next_cycle_)
        throw std::logic_error("VcdWriter: cycle " + std::to_string(cycle) + " has already ended");
    if (!header_written_)
        write_header();
    if (!past_window_) {
        if (pulses_ != 0 && cycle > next_cycle_)
            end_pulses();
        before_changes(cycle);
        std::size_t pulses = 0;
        for (std::size_t i = 0; i < changed_count_; ++i) {
            const Signal signal = changed_[i];
            Wire& wire = wires_[signal];
            if (wire.value != wire.shown) {
                if (shown_)
                    write_change(wire, wire.value);
                wire.shown = wire.value;
            }
            if (wire.state == State::pulsed) {
                wire.value = 0;
                wire.state = State::changed;
                changed_[pulses++] = signal;
            } else {
                wire.state = State::quiet;
            }
        }
        changed_count_ = pulses_ = pulses;
        after_changes(cycle);
        // From here on changes are ignored: every signal is added to changed_ once and stays.
        past_window_ = all_written_ && cycle >= window_.last;
    }
    next_cycle_ = cycle + 1;
}

/// Ends the last cycle's pulses, since no end_cycle() follows. Some may have been set again for a later cycle.
void VcdWriter::end_pulses() {
    before_changes(next_cycle_);
    for (std::size_t i = 0; i < pulses_; ++i) {
        Wire& wire = wires_[changed_[i]];
        if (shown_)
            write_change(wire, 0);
        wire.shown = 0;
    }
    after_changes(next_cycle_);
    pulses_ = 0;
}

void VcdWriter::before_changes(std::uint64_t cycle) {
    if (!all_written_ && cycle > window_.first)
        write_all_values(window_.first);
    now_ = cycle;
    shown_ = all_written_ && cycle <= window_.last;
    time_due_ = shown_;
}

void VcdWriter::after_changes(std::uint64_t cycle) {
    if (!all_written_ && cycle == window_.first)
        write_all_values(cycle);
}

void VcdWriter::finish(std::uint64_t cycle) {
    if (finished_)
        throw std::logic_error("VcdWriter: finish() was called twice");
    if (!header_written_)
        write_header();
    const std::uint64_t end = std::max(cycle, next_cycle_);
    if (pulses_ != 0 && !past_window_)
        end_pulses();
    if (!all_written_)
        write_all_values(std::min(window_.first, end));
    const std::uint64_t last_time = end <= window_.last ? end : window_.last + 1;
    if (last_time > last_time_)
        write_time(last_time);
    flush();
    out_.flush();
    finished_ = true;
}

void VcdWriter::write_change(const Wire& wire, std::uint64_t value) {
    make_room();
    if (time_due_) {
        write_time(now_);
        time_due_ = false;
    }
    write_value(wire, value);
    ++changes_;
}

void VcdWriter::write_value(const Wire& wire, std::uint64_t value) {
    char* to = buffer_.data() + used_;
    if (wire.mask == 1) {
        *to++ = static_cast<char>('0' + value);
    } else {
        // Leading zeros may be omitted. Whole bytes are copied; the excess is overwritten.
        const int digits = value == 0 ? 1 : 64 - __builtin_clzll(value);
        *to++ = 'b';
        value <<= 64 - digits;
        for (int done = 0; done < digits; done += 8, value <<= 8)
            std::memcpy(to + done, bytes_in_binary[value >> 56].data(), 8);
        to += digits;
    }
    std::memcpy(to, wire.tail, sizeof wire.tail);
    used_ = static_cast<std::size_t>(to - buffer_.data()) + wire.tail_length;
}

void VcdWriter::write_time(std::uint64_t cycle) {
    make_room();
    char* to = buffer_.data() + used_;
    *to++ = '#';
    to = std::to_chars(to, to + 20, cycle * cycle_units_).ptr;
    *to++ = '\n';
    used_ = static_cast<std::size_t>(to - buffer_.data());
    last_time_ = cycle;
}

void VcdWriter::write_all_values(std::uint64_t cycle) {
    constexpr char begin[] = "$dumpvars\n";
    constexpr char end[] = "$end\n";
    write_time(cycle);
    std::memcpy(buffer_.data() + used_, begin, sizeof begin - 1);
    used_ += sizeof begin - 1;
    for (const Wire& wire : wires_) {
        make_room();
        write_value(wire, wire.shown);
    }
    make_room();
    std::memcpy(buffer_.data() + used_, end, sizeof end - 1);
    used_ += sizeof end - 1;
    all_written_ = true;
}

void VcdWriter::make_room() {
    if (buffer_.size() - used_ < longest_entry)
        flush();
}

void VcdWriter::flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(used_));
    used_ = 0;
}

}  // namespace tessera
