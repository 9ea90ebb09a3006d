#include "testbench/faults/memory_fault.h"

#include "modules/memory/gather_extension.h"

namespace tessera {

MemoryFault::MemoryFault(const sc_core::sc_module_name& name, FaultTrigger& trigger)
    : sc_module(name), trigger_(trigger) {
    socket.register_b_transport(this, &MemoryFault::b_transport);
    socket.register_nb_transport_fw(this, &MemoryFault::nb_transport_fw);
    socket.register_transport_dbg(this, &MemoryFault::transport_dbg);
    to_memory.register_nb_transport_bw(this, &MemoryFault::nb_transport_bw);
}

unsigned MemoryFault::transport_dbg(Payload& payload) {
    return to_memory->transport_dbg(payload);
}

void MemoryFault::flip_data(const Payload& payload) {
    if (trigger_.bit() >= std::uint64_t{8} * payload.get_data_length()) {
        trigger_.has_no_such_bit();
        return;
    }
    unsigned char& byte = payload.get_data_ptr()[trigger_.bit() / 8];
    byte = static_cast<unsigned char>(byte ^ 1u << trigger_.bit() % 8);
}

void MemoryFault::flip_address(Payload& payload) {
    if (trigger_.bit() >= 64) {
        trigger_.has_no_such_bit();
        return;
    }
    const std::uint64_t flip = std::uint64_t{1} << trigger_.bit();
    payload.set_address(payload.get_address() ^ flip);
    if (auto* gather = payload.get_extension<GatherExtension>())
        gather->address[0] ^= flip;
}

void MemoryFault::b_transport(Payload& payload, sc_core::sc_time& delay) {
    const bool now = trigger_.strikes();
    if (now && trigger_.kind() == FaultKind::address_flip)
        flip_address(payload);
    if (now && trigger_.kind() == FaultKind::dropped)
        return;
    to_memory->b_transport(payload, delay);
    payload.set_dmi_allowed(false);
    if (!now)
        return;
    if (trigger_.kind() == FaultKind::bit_flip)
        flip_data(payload);
    else if (trigger_.kind() == FaultKind::error_response)
        payload.set_response_status(tlm::TLM_GENERIC_ERROR_RESPONSE);
    else if (trigger_.kind() == FaultKind::response_lost)
        payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
}

/// Kinds that need a request which the memory does not take at once.
bool MemoryFault::strikes_held_back() const {
    return trigger_.kind() == FaultKind::request_before_end || trigger_.kind() == FaultKind::response_early;
}

tlm::tlm_sync_enum MemoryFault::nb_transport_fw(Payload& payload, tlm::tlm_phase& phase,
                                                sc_core::sc_time& delay) {
    bool now = !strikes_held_back() && trigger_.strikes();
    if (now) {
        struck_ = &payload;
        if (trigger_.kind() == FaultKind::dropped) {
            phase = tlm::END_REQ;
            return tlm::TLM_UPDATED;
        }
        if (trigger_.kind() == FaultKind::address_flip)
            flip_address(payload);
        if (trigger_.kind() == FaultKind::bit_flip && payload.is_write())
            flip_data(payload);
    }
    const tlm::tlm_sync_enum status = to_memory->nb_transport_fw(payload, phase, delay);
    if (strikes_held_back() && status == tlm::TLM_ACCEPTED)
        now = trigger_.strikes();
    if (!now)
        return status;
    switch (trigger_.kind()) {
        case FaultKind::doubled:
        case FaultKind::request_before_end: {
            tlm::tlm_phase again = tlm::BEGIN_REQ;
            to_memory->nb_transport_fw(payload, again, delay);
            break;
        }
        case FaultKind::response_early:
            send_back(payload, tlm::BEGIN_RESP);
            break;
        case FaultKind::end_request_doubled:
            if (status == tlm::TLM_UPDATED)
                send_back(payload, tlm::END_REQ);
            break;
        default:
            break;
    }
    return status;
}

tlm::tlm_sync_enum MemoryFault::send_back(Payload& payload, const tlm::tlm_phase& phase) {
    tlm::tlm_phase its_phase = phase;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    return socket->nb_transport_bw(payload, its_phase, delay);
}

tlm::tlm_sync_enum MemoryFault::nb_transport_bw(Payload& payload, tlm::tlm_phase& phase,
                                                sc_core::sc_time& delay) {
    if (phase == tlm::BEGIN_RESP)
        return answer(payload, phase, delay);
    const tlm::tlm_sync_enum status = socket->nb_transport_bw(payload, phase, delay);
    if (&payload == struck_ && trigger_.kind() == FaultKind::end_request_doubled)
        send_back(payload, tlm::END_REQ);
    return status;
}

tlm::tlm_sync_enum MemoryFault::answer(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay) {
    if (&payload != struck_) {
        const tlm::tlm_sync_enum status = socket->nb_transport_bw(payload, phase, delay);
        if (held_ != nullptr) {
            send_back(*held_, tlm::BEGIN_RESP);
            held_ = nullptr;
            trigger_.waits_for_next(false);
        }
        return status;
    }
    struck_ = nullptr;  // the port uses its payloads again
    switch (trigger_.kind()) {
        case FaultKind::response_lost:
            return tlm::TLM_COMPLETED;
        case FaultKind::response_reordered:
            held_ = &payload;
            trigger_.waits_for_next(true);
            return tlm::TLM_COMPLETED;
        case FaultKind::error_response:
            payload.set_response_status(tlm::TLM_GENERIC_ERROR_RESPONSE);
            break;
        case FaultKind::bit_flip:
            if (payload.is_read())
                flip_data(payload);
            break;
        default:
            break;
    }
    const tlm::tlm_sync_enum status = socket->nb_transport_bw(payload, phase, delay);
    return trigger_.kind() == FaultKind::response_doubled ? send_back(payload, tlm::BEGIN_RESP) : status;
}

}  // namespace tessera
