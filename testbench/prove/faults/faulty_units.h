#pragma once
#include <memory>
#include <string>
#include <systemc>

#include "modules/sockets/stream_output.h"
#include "testbench/check/transport/read_checked_units.h"
#include "testbench/prove/faults/fault.h"
#include "testbench/prove/faults/memory_fault.h"

namespace tessera {

/// A machine with one injected fault, and with read checks.
class FaultyUnits : public ReadCheckedUnits {
  public:
    FaultyUnits(Fault fault, const datapath::Formats& formats, int tag_bits);

    void made(sc_core::sc_module& module) override;
    using ReadCheckedUnits::join;
    void join(MemoryPort& port, TableMemory& memory) override;
    void join(MemoryPort& port, OffChipMemory& memory) override;

    /// Whether the machine is built and has the fault's place.
    bool placed() const { return module_ != nullptr; }
    const FaultTrigger& trigger() const { return trigger_; }

  private:
    bool is_place(const sc_core::sc_object& socket) const;
    template <class Payload>
    void interpose(StreamOutput<Payload>& output);
    MemoryFault& fault_before(MemoryServer& memory);

    datapath::Formats formats_;
    int tag_bits_;
    FaultTrigger trigger_;
    std::unique_ptr<sc_core::sc_module> module_;  // the module inserted at the place
};

}  // namespace tessera
