#include "modules/memory/memory_port.h"

#include <sstream>

namespace tessera {

MemoryPort::MemoryPort(const char* name, unsigned entry_bytes, bool use_direct_memory)
    : socket(name),
      entry_bytes_(entry_bytes),
      mask_(entry_bytes >= 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << (8 * entry_bytes)) - 1),
      use_direct_memory_(use_direct_memory) {
    socket.register_invalidate_direct_mem_ptr(this, &MemoryPort::invalidate_direct_mem_ptr);
}

std::uint64_t MemoryPort::read_by_transaction(std::uint64_t address, sc_core::sc_time& delay) {
    ++reads_;
    unsigned char data[8] = {};
    payload_.set_command(tlm::TLM_READ_COMMAND);
    payload_.set_address(address);
    payload_.set_data_ptr(data);
    payload_.set_data_length(entry_bytes_);
    payload_.set_streaming_width(entry_bytes_);
    payload_.set_byte_enable_ptr(nullptr);
    payload_.set_dmi_allowed(false);
    payload_.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    socket->b_transport(payload_, delay);
    if (payload_.is_response_error()) {
        std::ostringstream message;
        message << socket.name() << ": read of " << entry_bytes_ << " bytes at address 0x" << std::hex
                << address << " answered " << payload_.get_response_string();
        SC_REPORT_ERROR("tessera/memory", message.str().c_str());
    }
    if (use_direct_memory_ && payload_.is_dmi_allowed() && direct_bytes_ == 0)
        ask_for_direct_memory();
    std::uint64_t entry = 0;
    std::memcpy(&entry, data, entry_bytes_);
    return entry;
}

void MemoryPort::ask_for_direct_memory() {
    tlm::tlm_dmi dmi;
    if (!socket->get_direct_mem_ptr(payload_, dmi) || !dmi.is_read_allowed())
        return;
    direct_ = dmi.get_dmi_ptr();
    direct_start_ = dmi.get_start_address();
    const std::uint64_t span = dmi.get_end_address() - dmi.get_start_address() + 1;
    direct_bytes_ = span >= sizeof(std::uint64_t) ? span - sizeof(std::uint64_t) + 1 : 0;
    direct_time_ = dmi.get_read_latency();
}

void MemoryPort::invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) {
    direct_bytes_ = 0;
}

}  // namespace tessera
