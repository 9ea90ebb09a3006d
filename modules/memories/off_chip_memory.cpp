#include "modules/memories/off_chip_memory.h"

#include "modules/stage/signals.h"

namespace tessera {

OffChipMemory::OffChipMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, const OffChipTiming& timing,
                             const StallParameters& stalls, std::uint64_t size, unsigned uncounted)
    : MemoryServer(name, clock, timing.buffer, stalls), storage_(0, size), channel_(timing), uncounted_(uncounted) {}

unsigned OffChipMemory::counted(const MemoryRequest& request) const {
    return request.bytes() > uncounted_ ? request.bytes() - uncounted_ : request.bytes();
}

void OffChipMemory::count_access(MemoryRequest& request) {
    access(storage_, request, true);
    if (request.is_ok())
        (request.command == tlm::TLM_WRITE_COMMAND ? bytes_written_ : bytes_read_) += counted(request);
}

std::uint64_t OffChipMemory::serve(MemoryRequest& request, std::uint64_t cycle) {
    count_access(request);
    last_address_ = request.address[0];
    last_is_write_ = request.command == tlm::TLM_WRITE_COMMAND;
    const std::uint64_t answer_at = channel_.serve(counted(request), cycle);
    busy_until_ = channel_.ready();
    wake_at(busy_until_);
    return answer_at;
}

void OffChipMemory::b_transport(int, MemoryRequest& request, sc_core::sc_time& delay) {
    count_access(request);
    if (request.is_ok())
        delay += clock_.period() * channel_.latency();
}

/// Shows the request served last.
void OffChipMemory::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.pulse("served", bytes_written_ + bytes_read_);
    signals.value("requests", 32, activity_.items_in());
    signals.value("address", 32, last_address_);
    signals.flag("write", last_is_write_);
    show_waiting(signals);
    signals.value("bytes_written", 32, bytes_written_);
    signals.value("bytes_read", 32, bytes_read_);
}

}  // namespace tessera
