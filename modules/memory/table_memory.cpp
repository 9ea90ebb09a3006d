#include "modules/memory/table_memory.h"

#include <cstring>

namespace tessera {

TableMemory::TableMemory(const sc_core::sc_module_name& name, const datapath::TableLayout& layout,
                         const sc_core::sc_time& read_time)
    : sc_module(name), layout_(layout), read_time_(read_time), storage_(layout.bytes()) {
    socket.register_b_transport(this, &TableMemory::b_transport);
    socket.register_get_direct_mem_ptr(this, &TableMemory::get_direct_mem_ptr);
    socket.register_transport_dbg(this, &TableMemory::transport_dbg);
}

bool TableMemory::covers(std::uint64_t address, std::uint64_t length) const {
    return address >= layout_.base && length <= layout_.bytes() &&
           address - layout_.base <= layout_.bytes() - length;
}

void TableMemory::b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
    if (payload.get_command() != tlm::TLM_READ_COMMAND) {
        payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
    } else if (payload.get_byte_enable_ptr() != nullptr) {
        payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
    } else if (payload.get_streaming_width() < payload.get_data_length()) {
        payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
    } else if (!covers(payload.get_address(), payload.get_data_length())) {
        payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
    } else {
        std::memcpy(payload.get_data_ptr(), &storage_[payload.get_address() - layout_.base],
                    payload.get_data_length());
        payload.set_dmi_allowed(true);
        payload.set_response_status(tlm::TLM_OK_RESPONSE);
        ++transactions_;
        delay += read_time_;
    }
}

bool TableMemory::get_direct_mem_ptr(int, tlm::tlm_generic_payload& payload, tlm::tlm_dmi& dmi) {
    if (payload.get_command() != tlm::TLM_READ_COMMAND || !covers(payload.get_address(), 1))
        return false;
    dmi.set_start_address(layout_.base);
    dmi.set_end_address(layout_.base + layout_.bytes() - 1);
    dmi.set_dmi_ptr(storage_.data());
    dmi.set_read_latency(read_time_);
    dmi.allow_read();
    return true;
}

unsigned TableMemory::transport_dbg(int, tlm::tlm_generic_payload& payload) {
    if (!covers(payload.get_address(), payload.get_data_length()))
        return 0;
    unsigned char* const place = &storage_[payload.get_address() - layout_.base];
    if (payload.get_command() == tlm::TLM_WRITE_COMMAND)
        std::memcpy(place, payload.get_data_ptr(), payload.get_data_length());
    else if (payload.get_command() == tlm::TLM_READ_COMMAND)
        std::memcpy(payload.get_data_ptr(), place, payload.get_data_length());
    return payload.get_data_length();
}

}  // namespace tessera
