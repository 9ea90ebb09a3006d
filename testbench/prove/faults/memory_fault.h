#pragma once
#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <cstdint>
#include <systemc>
#include <tlm>

#include "modules/sockets/memory_request.h"
#include "testbench/prove/faults/fault.h"

namespace tessera {

/// Inserted between a unit's memory port and the memory. Corrupts one transaction and forwards all others. Denies DMI,
/// so that functional mode cannot bypass it.
///
///   bit_flip             of the data: read, or about to be written
///   address_flip         a bit of the request's (first) address
///   dropped              END_REQ to the port, nothing to the memory
///   doubled              the memory gets the request twice, the port two responses (timed mode)
///   request_before_end   a second BEGIN_REQ while the memory withholds END_REQ
///   end_request_doubled  the port gets END_REQ twice
///   error_response       TLM_GENERIC_ERROR_RESPONSE
///   response_lost        the response is dropped
///   response_doubled     the response is sent twice
///   response_early       the response is sent while END_REQ is withheld
///   response_reordered   the next request's response is sent first; not for the last of a run
class MemoryFault : public sc_core::sc_module {
  public:
    tlm_utils::passthrough_target_socket<MemoryFault, 32, MemoryProtocol> socket{"socket"};
    tlm_utils::simple_initiator_socket<MemoryFault, 32, MemoryProtocol> to_memory{"to_memory"};

    /// `trigger` must outlive it.
    MemoryFault(const sc_core::sc_module_name& name, FaultTrigger& trigger);

  private:
    void b_transport(MemoryRequest& request, sc_core::sc_time& delay);
    tlm::tlm_sync_enum nb_transport_fw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay);
    tlm::tlm_sync_enum nb_transport_bw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay);
    unsigned transport_dbg(MemoryRequest& request);
    tlm::tlm_sync_enum answer(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay);
    tlm::tlm_sync_enum send_back(MemoryRequest& request, const tlm::tlm_phase& phase);
    void flip_data(const MemoryRequest& request);
    void flip_address(MemoryRequest& request);

    FaultTrigger& trigger_;
    const MemoryRequest* struck_ = nullptr;  // its response is still to be corrupted
    MemoryRequest* held_ = nullptr;          // a response that waits for the next one
};

}  // namespace tessera
