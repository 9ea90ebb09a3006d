#pragma once
#include <cstdint>
#include <string>

namespace tessera {

/// Receives the signals that units show (modules/stage/signals.h) and their values. Implemented by the testbench's
/// VcdWriter (testbench/output/trace/vcd_writer.h), which writes them to a file.
class SignalSink {
  public:
    using Signal = std::uint32_t;

    /// Declares a signal. scope: its dotted hierarchical name; bits: 1 to 64. Call once per scope and name, before the
    /// first value.
    virtual Signal add(const std::string& scope, const std::string& name, unsigned bits) = 0;

    /// Sets the value from this cycle on. Bits beyond the signal's width are dropped; signed values: two's complement.
    virtual void set(Signal signal, std::uint64_t value) = 0;

    /// Sets the value to 1 in this cycle and to 0 in the next, unless it is set or pulsed there.
    virtual void pulse(Signal signal) = 0;

    virtual ~SignalSink() = default;
};

}  // namespace tessera
