#include "modules/memory/table_memory.h"

#include <algorithm>
#include <cstring>

#include "modules/unit/signals.h"

namespace tessera {

namespace {

struct Entries {
    const std::uint64_t* addresses;
    unsigned count;
};

Entries entries_of(const tlm::tlm_generic_payload& payload, const std::uint64_t& address) {
    const auto* gather = payload.get_extension<GatherExtension>();
    return gather == nullptr ? Entries{&address, 1} : Entries{gather->address.data(), gather->count};
}

}  // namespace

TableMemory::TableMemory(const sc_core::sc_module_name& name, Clock& clock,
                         const datapath::TableLayout& layout, const MemoryTiming& timing,
                         const StallParameters& stalls)
    : MemoryServer(name, clock, timing.buffer, stalls),
      storage_(layout.base, layout.bytes()),
      ports_(timing, layout) {
    storage_.all();
}

void TableMemory::read(Payload& payload) {
    const unsigned length = payload.get_data_length();
    if (payload.get_command() != tlm::TLM_READ_COMMAND) {
        payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
        return;
    }
    if (payload.get_byte_enable_ptr() != nullptr) {
        payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
        return;
    }
    if (payload.get_streaming_width() < length) {
        payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
        return;
    }
    const std::uint64_t own_address = payload.get_address();
    const auto [addresses, count] = entries_of(payload, own_address);
    const unsigned each = length / count;
    for (unsigned k = 0; k < count; ++k) {
        if (!storage_.covers(addresses[k], each)) {
            payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
            return;
        }
        storage_.read(addresses[k], payload.get_data_ptr() + std::size_t{k} * each, each);
    }
    transactions_ += count;
    payload.set_dmi_allowed(true);
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
}

std::uint64_t TableMemory::ready(const Payload& payload) const {
    const std::uint64_t own_address = payload.get_address();
    const auto [addresses, count] = entries_of(payload, own_address);
    return ports_.ready(addresses, count);
}

std::uint64_t TableMemory::serve(Payload& payload, std::uint64_t cycle) {
    read(payload);
    const std::uint64_t own_address = payload.get_address();
    const auto [addresses, count] = entries_of(payload, own_address);
    last_ = {own_address, count, 0};
    std::memcpy(&last_.data, payload.get_data_ptr(),
                std::min<std::size_t>(payload.get_data_length() / count, sizeof last_.data));
    return ports_.serve(addresses, count, cycle);
}

void TableMemory::b_transport(int, Payload& payload, sc_core::sc_time& delay) {
    read(payload);
    if (payload.is_response_ok())
        delay += clock_.period() * ports_.latency();
}

bool TableMemory::get_direct_mem_ptr(int, Payload& payload, tlm::tlm_dmi& dmi) {
    if (payload.get_command() != tlm::TLM_READ_COMMAND || !storage_.covers(payload.get_address(), 1))
        return false;
    dmi.set_start_address(storage_.base());
    dmi.set_end_address(storage_.base() + storage_.size() - 1);
    dmi.set_dmi_ptr(storage_.all());
    dmi.set_read_latency(clock_.period() * ports_.latency());
    dmi.allow_read();
    return true;
}

/// Shows the request served last, of which data is the first entry, and how many requests have come and entries have
/// been read: several in a cycle, or in cycles that follow each other, are one pulse.
void TableMemory::show(Signals& signals) const {
    Unit::show(signals);
    signals.pulse("served", slots_taken());
    signals.value("requests", 32, activity_.items_in());
    signals.value("reads", 32, transactions_);
    signals.group(signals.changed(slots_taken()) && signals.running(), [&] {
        signals.value("address", 32, last_.address);
        signals.value("entries", 4, last_.entries);
        signals.value("data", 64, last_.data);
    });
    signals.flag("held_up", held_up());
    show_waiting(signals);
}

}  // namespace tessera
