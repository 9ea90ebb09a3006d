#pragma once
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "modules/stage/signal_sink.h"
#include "testbench/output/trace/trace_window.h"

namespace tessera {

/// Writes signals as a value change dump (IEEE 1364) for GTKWave. Replaces sc_trace, which checks every signal in every
/// step and takes ten times as long per change.
///
/// Use: add() all signals; in each cycle with any activity set() and pulse(), then end_cycle(); finish(). A signal is 0
/// until it is first set. Of several values within a cycle the last one counts, pulse or not.
/// Window: nothing is written outside it, but values are tracked. The file begins with the values of the window's first
/// cycle, or of the run's last one if the window was never reached.
/// Time: whole numbers of the largest power of ten that divides the clock's period. Equal runs give equal files: no
/// date.
/// Limits: a cycle's time in picoseconds fits 64 bits, as in sc_time. The caller must check the stream's state. Misuse
/// throws std::logic_error, except for a Signal not returned by add().
class VcdWriter final : public SignalSink {
  public:
    VcdWriter(std::ostream& out, std::uint64_t cycle_picoseconds, TraceWindow window = {});
    VcdWriter(const VcdWriter&) = delete;
    VcdWriter& operator=(const VcdWriter&) = delete;

    /// Call before the first end_cycle().
    Signal add(const std::string& scope, const std::string& name, unsigned bits) override;

    void set(Signal signal, std::uint64_t value) override {
        Wire& wire = wires_[signal];
        value &= wire.mask;
        if (value == wire.value && wire.state != State::pulsed)
            return;
        if (wire.state == State::quiet)
            changed_[changed_count_++] = signal;
        wire.value = value;
        wire.state = State::changed;
    }

    /// The pulse ends in the next cycle without a call.
    void pulse(Signal signal) override {
        Wire& wire = wires_[signal];
        if (wire.state == State::quiet)
            changed_[changed_count_++] = signal;
        wire.value = 1;
        wire.state = State::pulsed;
    }

    /// Values set since the last call are valid from `cycle` on. Cycles increase strictly.
    void end_cycle(std::uint64_t cycle);

    /// The run ends at the beginning of `cycle`, or one cycle after the last end_cycle() if that is later.
    void finish(std::uint64_t cycle);

    /// Number of value changes written, without the initial values.
    std::uint64_t changes() const { return changes_; }

  private:
    enum class State : std::uint8_t { quiet, changed, pulsed };  // all but quiet ones are in changed_

    struct Wire {
        std::uint64_t value = 0;
        std::uint64_t shown = 0;  // its value in the file, or the value it would have outside the window
        std::uint64_t mask = 0;
        char tail[8] = {};  // what follows a value in the file
        std::uint8_t tail_length = 0;
        State state = State::quiet;
    };
    struct Variable {
        std::string name;
        unsigned bits;
        Signal signal;
    };
    struct Scope {
        std::string name;
        std::vector<std::size_t> scopes;
        std::vector<Variable> variables;
    };

    std::size_t find_scope(const std::string& path);
    void write_header();
    void write_scope(const Scope& scope, std::string& text) const;

    void end_pulses();
    void before_changes(std::uint64_t cycle);
    void after_changes(std::uint64_t cycle);
    void write_change(const Wire& wire, std::uint64_t value);
    void write_value(const Wire& wire, std::uint64_t value);
    void write_time(std::uint64_t cycle);
    void write_all_values(std::uint64_t cycle);
    void make_room();
    void flush();

    std::ostream& out_;
    TraceWindow window_;
    std::uint64_t cycle_units_;
    std::string timescale_;
    std::vector<Scope> scopes_{1};  // the first one has no name and contains the others

    std::vector<Wire> wires_;
    std::vector<Signal> changed_;  // reserved for all signals
    std::size_t changed_count_ = 0;
    std::size_t pulses_ = 0;  // number of leading elements of changed_ that were pulsed in the last cycle

    std::uint64_t next_cycle_ = 0;  // the first cycle that may end next
    std::uint64_t now_ = 0;
    std::uint64_t last_time_ = 0;  // the last time stamp, in cycles
    bool header_written_ = false;
    bool all_written_ = false;  // the values at the window's first cycle
    bool shown_ = false;        // changes at now_ are in the window
    bool time_due_ = false;     // their time stamp has not been written yet
    bool past_window_ = false;
    bool finished_ = false;
    std::uint64_t changes_ = 0;

    std::vector<char> buffer_;
    std::size_t used_ = 0;
};

}  // namespace tessera
