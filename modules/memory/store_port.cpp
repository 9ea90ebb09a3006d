#include "modules/memory/store_port.h"

#include <sstream>

#include "modules/stream/stream.h"

namespace tessera {

struct StorePort::Slot {
    Slot(tlm::tlm_mm_interface* manager, std::size_t bytes) : payload(manager), data(bytes) {}

    tlm::tlm_generic_payload payload;
    std::vector<unsigned char> data;
    bool answered = false;
};

StorePort::StorePort(const char* name, Clock& clock, Clocked& unit, std::size_t record_bytes,
                     std::size_t most_under_way)
    : socket(name), clock_(clock), unit_(unit) {
    for (std::size_t k = 0; k < most_under_way; ++k)
        slots_.push_back(std::make_unique<Slot>(this, record_bytes));
    socket.register_nb_transport_bw(this, &StorePort::nb_transport_bw);
}

StorePort::~StorePort() = default;

unsigned char* StorePort::record_to_write() {
    return slot(under_way_).data.data();
}

void StorePort::write(std::uint64_t address) {
    request(tlm::TLM_WRITE_COMMAND, address);
}

void StorePort::read(std::uint64_t address) {
    request(tlm::TLM_READ_COMMAND, address);
}

void StorePort::request(tlm::tlm_command command, std::uint64_t address) {
    if (on_offer_)
        stream_protocol_error(socket.name(), "BEGIN_REQ before END_REQ of the request before", &clock_);
    Slot& it = slot(under_way_++);
    it.answered = false;
    tlm::tlm_generic_payload& payload = it.payload;
    payload.acquire();
    payload.set_command(command);
    payload.set_address(address);
    payload.set_data_ptr(it.data.data());
    payload.set_data_length(static_cast<unsigned>(it.data.size()));
    payload.set_streaming_width(payload.get_data_length());
    payload.set_byte_enable_ptr(nullptr);
    payload.set_dmi_allowed(false);
    payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    const tlm::tlm_sync_enum status = socket->nb_transport_fw(payload, phase, delay);
    if (status == tlm::TLM_UPDATED && phase == tlm::END_REQ)
        return;
    if (status != tlm::TLM_ACCEPTED)
        stream_protocol_error(socket.name(), "BEGIN_REQ was answered by neither END_REQ nor TLM_ACCEPTED",
                              &clock_);
    on_offer_ = true;
}

tlm::tlm_sync_enum StorePort::nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                              sc_core::sc_time& delay) {
    clock_.wake_at(unit_, clock_.cycle() + clock_.cycles(delay));
    if (phase == tlm::END_REQ) {
        if (!on_offer_ || &slot(under_way_ - 1).payload != &payload)
            stream_protocol_error(socket.name(), "END_REQ for a request that is not on offer", &clock_);
        on_offer_ = false;
        return tlm::TLM_ACCEPTED;
    }
    if (phase != tlm::BEGIN_RESP)
        stream_protocol_error(socket.name(), "a phase that no memory may send", &clock_);
    for (std::size_t k = 0; k < under_way_; ++k) {
        Slot& it = slot(k);
        if (it.answered)
            continue;
        if (&it.payload != &payload || (on_offer_ && k + 1 == under_way_))
            stream_protocol_error(socket.name(), "BEGIN_RESP out of order or before END_REQ", &clock_);
        if (payload.is_response_error()) {
            std::ostringstream message;
            message << socket.name() << ": access to address 0x" << std::hex << payload.get_address()
                    << " answered " << payload.get_response_string();
            SC_REPORT_ERROR("tessera/memory", message.str().c_str());
        }
        it.answered = true;
        payload.release();
        return tlm::TLM_COMPLETED;
    }
    stream_protocol_error(socket.name(), "BEGIN_RESP for a request that was not made", &clock_);
}

bool StorePort::answered() const {
    return under_way_ > 0 && slot(0).answered;
}

bool StorePort::answer_is_read() const {
    return slot(0).payload.is_read();
}

const unsigned char* StorePort::answer() const {
    return slot(0).data.data();
}

void StorePort::pop_answer() {
    first_ = first_ + 1 == slots_.size() ? 0 : first_ + 1;
    --under_way_;
}

}  // namespace tessera
