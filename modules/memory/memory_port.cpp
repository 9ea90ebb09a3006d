#include "modules/memory/memory_port.h"

#include <algorithm>
#include <sstream>

#include "modules/stream/stream.h"

namespace tessera {

MemoryPort::MemoryPort(const char* name, unsigned entry_bytes, bool use_direct_memory)
    : socket(name),
      entry_bytes_(entry_bytes),
      mask_(entry_bytes >= 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << (8 * entry_bytes)) - 1),
      use_direct_memory_(use_direct_memory) {
    socket.register_invalidate_direct_mem_ptr(this, &MemoryPort::invalidate_direct_mem_ptr);
    socket.register_nb_transport_bw(this, &MemoryPort::nb_transport_bw);
}

MemoryPort::~MemoryPort() = default;

void MemoryPort::check_response(const tlm::tlm_generic_payload& payload) const {
    if (!payload.is_response_error())
        return;
    std::ostringstream message;
    message << socket.name() << ": read of " << payload.get_data_length() << " bytes at address 0x"
            << std::hex << payload.get_address() << " answered " << payload.get_response_string();
    SC_REPORT_ERROR("tessera/memory", message.str().c_str());
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
    check_response(payload_);
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

void MemoryPort::clocked_by(Clock& clock, Clocked& unit, std::size_t most_under_way) {
    clock_ = &clock;
    unit_ = &unit;
    slots_.clear();
    for (std::size_t k = 0; k < most_under_way; ++k)
        slots_.push_back(std::make_unique<Slot>(this));
}

void MemoryPort::request(const std::uint64_t* addresses, unsigned count) {
    if (on_offer_)
        stream_protocol_error(socket.name(), "BEGIN_REQ before END_REQ of the request before", clock_);
    ++under_way_;
    ++requests_;
    reads_ += count;
    Slot& slot = last();
    slot.taken = false;
    slot.gather.count = count;
    std::copy_n(addresses, count, slot.gather.address.begin());
    tlm::tlm_generic_payload& payload = slot.payload;
    payload.acquire();
    payload.set_command(tlm::TLM_READ_COMMAND);
    payload.set_address(addresses[0]);
    payload.set_data_ptr(slot.data.data());
    payload.set_data_length(count * entry_bytes_);
    payload.set_streaming_width(count * entry_bytes_);
    payload.set_byte_enable_ptr(nullptr);
    payload.set_dmi_allowed(false);
    payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    const tlm::tlm_sync_enum status = socket->nb_transport_fw(payload, phase, delay);
    if (status == tlm::TLM_UPDATED && phase == tlm::END_REQ)
        slot.taken = true;
    else if (status == tlm::TLM_ACCEPTED)
        on_offer_ = true;
    else
        stream_protocol_error(socket.name(), "BEGIN_REQ was answered by neither END_REQ nor TLM_ACCEPTED",
                              clock_);
}

tlm::tlm_sync_enum MemoryPort::nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                               sc_core::sc_time& delay) {
    const std::uint64_t cycle = clock_->cycle() + clock_->cycles(delay);
    clock_->wake_at(*unit_, cycle);
    if (phase == tlm::END_REQ) {
        if (!on_offer_ || &last().payload != &payload)
            stream_protocol_error(socket.name(), "END_REQ for a request that is not on offer", clock_);
        on_offer_ = false;
        last().taken = true;
        return tlm::TLM_ACCEPTED;
    }
    if (phase != tlm::BEGIN_RESP)
        stream_protocol_error(socket.name(), "a phase that no memory may send", clock_);
    if (answered_ == under_way_)
        stream_protocol_error(socket.name(), "BEGIN_RESP for a request that was not made", clock_);
    const std::size_t sum = first_ + answered_;
    Slot& slot = *slots_[sum < slots_.size() ? sum : sum - slots_.size()];
    if (&slot.payload != &payload || !slot.taken)
        stream_protocol_error(socket.name(), "BEGIN_RESP out of order or before END_REQ", clock_);
    check_response(payload);
    ++answered_;
    payload.release();
    return tlm::TLM_COMPLETED;
}

void MemoryPort::pop_answer() {
    first_ = first_ + 1 == slots_.size() ? 0 : first_ + 1;
    --under_way_;
    --answered_;
}

}  // namespace tessera
