#pragma once
#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <functional>
#include <systemc>
#include <tlm>
#include <utility>
#include <vector>

#include "modules/sockets/memory_request.h"

/// An initiator and a target whose phases are controlled by the test, to be connected to a memory or a memory port.
namespace tessera::testing {

/// An initiator whose phases are controlled by the test.
struct Initiator : sc_core::sc_module {
    tlm_utils::simple_initiator_socket<Initiator, 32, MemoryProtocol> socket{"socket"};
    std::vector<std::pair<tlm::tlm_phase, MemoryRequest*>> back;
    tlm::tlm_sync_enum reply = tlm::TLM_COMPLETED;

    explicit Initiator(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_nb_transport_bw(this, &Initiator::nb_transport_bw);
    }
    tlm::tlm_sync_enum send(MemoryRequest& request, tlm::tlm_phase phase,
                            sc_core::sc_time delay = sc_core::SC_ZERO_TIME) {
        return socket->nb_transport_fw(request, phase, delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_bw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time&) {
        back.emplace_back(phase, &request);
        return phase == tlm::BEGIN_RESP ? reply : tlm::TLM_ACCEPTED;
    }
};

/// A target whose phases are controlled by the test; records received requests.
struct Target : sc_core::sc_module {
    tlm_utils::passthrough_target_socket<Target, 32, MemoryProtocol> socket{"socket"};
    std::vector<MemoryRequest*> come;
    tlm::tlm_sync_enum status = tlm::TLM_UPDATED;
    tlm::tlm_phase phase_back = tlm::END_REQ;
    std::function<void(MemoryRequest&)> on_request = [](MemoryRequest&) {};  ///< called before the return

    explicit Target(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_nb_transport_fw(this, &Target::nb_transport_fw);
    }
    tlm::tlm_sync_enum send_back(MemoryRequest& request, tlm::tlm_phase phase,
                                 sc_core::sc_time delay = sc_core::SC_ZERO_TIME) {
        return socket->nb_transport_bw(request, phase, delay);
    }

  private:
    tlm::tlm_sync_enum nb_transport_fw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time&) {
        come.push_back(&request);
        on_request(request);
        phase = phase_back;
        return status;
    }
};

inline MemoryRequest read_of(unsigned char* data, std::uint64_t address, unsigned bytes = 4) {
    return {tlm::TLM_READ_COMMAND, 1, bytes, {address}, data};
}

}  // namespace tessera::testing
