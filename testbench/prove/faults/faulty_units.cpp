#include "testbench/prove/faults/faulty_units.h"

#include <utility>

#include "testbench/prove/faults/stream_fault.h"

namespace tessera {

FaultyUnits::FaultyUnits(Fault fault, const datapath::Formats& formats, int tag_bits)
    : formats_(formats), tag_bits_(tag_bits), trigger_(std::move(fault)) {}

bool FaultyUnits::is_place(const sc_core::sc_object& socket) const {
    const std::string& place = trigger_.fault().place;
    return socket.name() == place || socket.name() == "tessera." + place;
}

template <class Payload>
void FaultyUnits::interpose(StreamOutput<Payload>& output) {
    if (!is_place(output))
        return;
    output.interpose([this](StreamOutput<Payload>& from, StreamInput<Payload>& to) {
        auto fault = std::make_unique<StreamFault<Payload>>("fault", trigger_, formats_, tag_bits_, to);
        from.bind(fault->in);
        fault->out.bind(to);
        module_ = std::move(fault);
    });
}

void FaultyUnits::made(sc_core::sc_module& module) {
    for_each_output(module, [&](auto& output) { interpose(output); });
}

MemoryFault& FaultyUnits::fault_before(MemoryServer& memory) {
    auto fault = std::make_unique<MemoryFault>("fault", trigger_);
    fault->to_memory.bind(memory.socket);
    MemoryFault& made = *fault;
    module_ = std::move(fault);
    return made;
}

void FaultyUnits::join(MemoryPort& port, TableMemory& memory) {
    if (is_place(port.socket))
        check(port, memory).to_memory.bind(fault_before(memory).socket);
    else
        ReadCheckedUnits::join(port, memory);
}

void FaultyUnits::join(MemoryPort& port, OffChipMemory& memory) {
    if (is_place(port.socket))
        port.bind(fault_before(memory), memory);
    else
        port.bind(memory);
}

}  // namespace tessera
