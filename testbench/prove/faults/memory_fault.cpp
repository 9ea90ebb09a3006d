#include "testbench/prove/faults/memory_fault.h"

namespace tessera {

MemoryFault::MemoryFault(const sc_core::sc_module_name& name, FaultTrigger& trigger)
    : sc_module(name), trigger_(trigger) {
    socket.register_b_transport(this, &MemoryFault::b_transport);
    socket.register_nb_transport_fw(this, &MemoryFault::nb_transport_fw);
    socket.register_transport_dbg(this, &MemoryFault::transport_dbg);
    to_memory.register_nb_transport_bw(this, &MemoryFault::nb_transport_bw);
}

unsigned MemoryFault::transport_dbg(MemoryRequest& request) {
    return to_memory->transport_dbg(request);
}

void MemoryFault::flip_data(const MemoryRequest& request) {
    const std::uint64_t bit = trigger_.fault().bit;
    trigger_.require_bit(bit < std::uint64_t{8} * request.bytes());
    unsigned char& byte = request.data[bit / 8];
    byte = static_cast<unsigned char>(byte ^ 1u << bit % 8);
}

void MemoryFault::flip_address(MemoryRequest& request) {
    trigger_.require_bit(trigger_.fault().bit < 64);
    request.address[0] ^= std::uint64_t{1} << trigger_.fault().bit;
}

void MemoryFault::b_transport(MemoryRequest& request, sc_core::sc_time& delay) {
    const bool now = trigger_.strikes();
    if (now && trigger_.kind() == FaultKind::address_flip)
        flip_address(request);
    if (now && trigger_.kind() == FaultKind::dropped)
        return;
    to_memory->b_transport(request, delay);
    request.dmi_allowed = false;
    if (!now)
        return;
    if (trigger_.kind() == FaultKind::bit_flip)
        flip_data(request);
    else if (trigger_.kind() == FaultKind::error_response)
        request.response = tlm::TLM_GENERIC_ERROR_RESPONSE;
    else if (trigger_.kind() == FaultKind::response_lost)
        request.response = tlm::TLM_INCOMPLETE_RESPONSE;
}

tlm::tlm_sync_enum MemoryFault::nb_transport_fw(MemoryRequest& request, tlm::tlm_phase& phase,
                                                sc_core::sc_time& delay) {
    const bool when_held_back = strikes_held_back(trigger_.kind());
    bool now = !when_held_back && trigger_.strikes();
    if (now) {
        struck_ = &request;
        if (trigger_.kind() == FaultKind::dropped) {
            phase = tlm::END_REQ;
            return tlm::TLM_UPDATED;
        }
        if (trigger_.kind() == FaultKind::address_flip)
            flip_address(request);
        if (trigger_.kind() == FaultKind::bit_flip && request.command == tlm::TLM_WRITE_COMMAND)
            flip_data(request);
    }
    const tlm::tlm_sync_enum status = to_memory->nb_transport_fw(request, phase, delay);
    if (when_held_back && status == tlm::TLM_ACCEPTED)
        now = trigger_.strikes();
    if (!now)
        return status;
    switch (trigger_.kind()) {
        case FaultKind::doubled:
        case FaultKind::request_before_end: {
            tlm::tlm_phase again = tlm::BEGIN_REQ;
            to_memory->nb_transport_fw(request, again, delay);
            break;
        }
        case FaultKind::response_early: send_back(request, tlm::BEGIN_RESP); break;
        case FaultKind::end_request_doubled:
            if (status == tlm::TLM_UPDATED)
                send_back(request, tlm::END_REQ);
            break;
        default: break;
    }
    return status;
}

tlm::tlm_sync_enum MemoryFault::send_back(MemoryRequest& request, const tlm::tlm_phase& phase) {
    tlm::tlm_phase its_phase = phase;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    return socket->nb_transport_bw(request, its_phase, delay);
}

tlm::tlm_sync_enum MemoryFault::nb_transport_bw(MemoryRequest& request, tlm::tlm_phase& phase,
                                                sc_core::sc_time& delay) {
    if (phase == tlm::BEGIN_RESP)
        return answer(request, phase, delay);
    const tlm::tlm_sync_enum status = socket->nb_transport_bw(request, phase, delay);
    if (&request == struck_ && trigger_.kind() == FaultKind::end_request_doubled)
        send_back(request, tlm::END_REQ);
    return status;
}

tlm::tlm_sync_enum MemoryFault::answer(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay) {
    if (&request != struck_) {
        const tlm::tlm_sync_enum status = socket->nb_transport_bw(request, phase, delay);
        if (held_ != nullptr) {
            send_back(*held_, tlm::BEGIN_RESP);
            held_ = nullptr;
            trigger_.wait_for_next(false);
        }
        return status;
    }
    struck_ = nullptr;  // the port reuses its payloads
    switch (trigger_.kind()) {
        case FaultKind::response_lost: return tlm::TLM_COMPLETED;
        case FaultKind::response_reordered:
            held_ = &request;
            trigger_.wait_for_next(true);
            return tlm::TLM_COMPLETED;
        case FaultKind::error_response: request.response = tlm::TLM_GENERIC_ERROR_RESPONSE; break;
        case FaultKind::bit_flip:
            if (request.command == tlm::TLM_READ_COMMAND)
                flip_data(request);
            break;
        default: break;
    }
    const tlm::tlm_sync_enum status = socket->nb_transport_bw(request, phase, delay);
    return trigger_.kind() == FaultKind::response_doubled ? send_back(request, tlm::BEGIN_RESP) : status;
}

}  // namespace tessera
