#pragma once
#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <systemc>
#include <tlm>
#include <utility>
#include <vector>

/// The other side of a memory's socket, or of a port on one: an initiator and a target whose phases are the test's.
namespace tessera::testing {

using Transaction = tlm::tlm_generic_payload;

/// The reuse of payloads is the test's own matter.
struct Manager : tlm::tlm_mm_interface {
    void free(Transaction*) override {}
};

/// An initiator whose phases are the test's.
struct Initiator : sc_core::sc_module {
    tlm_utils::simple_initiator_socket<Initiator> socket{"socket"};
    std::vector<std::pair<tlm::tlm_phase, Transaction*>> back;
    tlm::tlm_sync_enum reply = tlm::TLM_COMPLETED;

    explicit Initiator(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_nb_transport_bw(this, &Initiator::nb_transport_bw);
    }
    tlm::tlm_sync_enum send(Transaction& payload, tlm::tlm_phase phase,
                            sc_core::sc_time delay = sc_core::SC_ZERO_TIME) {
        return socket->nb_transport_fw(payload, phase, delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_bw(Transaction& payload, tlm::tlm_phase& phase, sc_core::sc_time&) {
        back.emplace_back(phase, &payload);
        return phase == tlm::BEGIN_RESP ? reply : tlm::TLM_ACCEPTED;
    }
};

/// A target whose phases are the test's; keeps what it is sent.
struct Target : sc_core::sc_module {
    tlm_utils::passthrough_target_socket<Target> socket{"socket"};
    std::vector<Transaction*> come;
    tlm::tlm_sync_enum status = tlm::TLM_UPDATED;
    tlm::tlm_phase phase_back = tlm::END_REQ;

    explicit Target(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_nb_transport_fw(this, &Target::nb_transport_fw);
    }
    tlm::tlm_sync_enum send_back(Transaction& payload, tlm::tlm_phase phase,
                                 sc_core::sc_time delay = sc_core::SC_ZERO_TIME) {
        return socket->nb_transport_bw(payload, phase, delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_fw(Transaction& payload, tlm::tlm_phase& phase, sc_core::sc_time&) {
        come.push_back(&payload);
        phase = phase_back;
        return status;
    }
};

inline void make_read(Transaction& payload, unsigned char* data, std::uint64_t address, unsigned length = 4) {
    payload.set_command(tlm::TLM_READ_COMMAND);
    payload.set_address(address);
    payload.set_data_ptr(data);
    payload.set_data_length(length);
    payload.set_streaming_width(length);
    payload.set_byte_enable_ptr(nullptr);
    payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
}

}  // namespace tessera::testing
