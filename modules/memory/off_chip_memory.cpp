#include "modules/memory/off_chip_memory.h"

#include "modules/unit/signals.h"

namespace tessera {

OffChipMemory::OffChipMemory(const sc_core::sc_module_name& name, Clock& clock, const OffChipTiming& timing,
                             const StallParameters& stalls, std::uint64_t size, unsigned uncounted)
    : MemoryServer(name, clock, timing.buffer, stalls),
      storage_(0, size),
      channel_(timing),
      uncounted_(uncounted) {}

unsigned OffChipMemory::counted(const Payload& payload) const {
    const unsigned length = payload.get_data_length();
    return length > uncounted_ ? length - uncounted_ : length;
}

void OffChipMemory::access(Payload& payload) {
    if (!payload.is_read() && !payload.is_write()) {
        payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
    } else if (move(storage_, payload) == 0) {
        payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    } else {
        payload.set_response_status(tlm::TLM_OK_RESPONSE);
        (payload.is_write() ? bytes_written_ : bytes_read_) += counted(payload);
    }
}

std::uint64_t OffChipMemory::serve(Payload& payload, std::uint64_t cycle) {
    access(payload);
    last_address_ = payload.get_address();
    last_is_write_ = payload.is_write();
    const std::uint64_t answer_at = channel_.serve(counted(payload), cycle);
    wake_at(channel_.ready());  // no longer busy
    return answer_at;
}

void OffChipMemory::b_transport(int, Payload& payload, sc_core::sc_time& delay) {
    access(payload);
    delay += clock_.period() * channel_.latency();
}

/// Shows the request served last.
void OffChipMemory::show(Signals& signals) const {
    Unit::show(signals);
    signals.pulse("served", channel_.occupied_cycles());
    signals.value("requests", 32, activity_.items_in());
    signals.value("address", 32, last_address_);
    signals.flag("write", last_is_write_);
    show_waiting(signals);
    signals.value("bytes_written", 32, bytes_written_);
    signals.value("bytes_read", 32, bytes_read_);
}

}  // namespace tessera
