#pragma once
#include <cstdint>
#include <string>

namespace tessera {

/// Takes the signals that units show (modules/stage/signals.h) and their values. Implemented by the testbench's
/// VcdWriter (testbench/output/trace/vcd_writer.h), which writes them to a file.
class SignalSink {
  public:
    using Signal = std::uint32_t;

    /// scope: the hierarchy, dotted; bits: 1 to 64. Before the first value, once per scope and name.
    virtual Signal add(const std::string& scope, const std::string& name, unsigned bits) = 0;

    /// From this cycle on. Bits beyond the signal's are dropped; a signed value comes as its two's complement.
    virtual void set(Signal signal, std::uint64_t value) = 0;

    /// 1 in this cycle and 0 in the next one, unless set or pulsed there.
    virtual void pulse(Signal signal) = 0;

    virtual ~SignalSink() = default;
};

}  // namespace tessera
