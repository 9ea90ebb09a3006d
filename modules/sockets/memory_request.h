#pragma once
#include <array>
#include <cstdint>
#include <tlm>

#include "modules/datapath/rectangle.h"

namespace tessera {

/// A request to a memory: to read or write entries of one size at addresses of their own. The corners of a rectangle,
/// which occupy a port one after another, are one request (a handshake for each would cost more host time than
/// everything else together).
struct MemoryRequest {
    tlm::tlm_command command = tlm::TLM_READ_COMMAND;
    unsigned count = 1;                                                     ///< entries, at least 1
    unsigned entry_bytes = 0;                                               ///< of each, at least 1
    std::array<std::uint64_t, datapath::most_rectangle_entries> address{};  ///< of each, in bytes
    unsigned char* data = nullptr;  ///< the entries, one after another, each little endian
    tlm::tlm_response_status response = tlm::TLM_INCOMPLETE_RESPONSE;
    bool dmi_allowed = false;  ///< set by a memory whose entries may be read through DMI

    unsigned bytes() const { return count * entry_bytes; }
    unsigned char* entry(unsigned k) const { return data + std::size_t{k} * entry_bytes; }
    bool is_ok() const { return response == tlm::TLM_OK_RESPONSE; }
};

/// The protocol between a unit's MemoryPort and a MemoryServer: traits of its own, because a memory that knows of one
/// address only would answer a gather wrongly. base_protocol_bridge.h leads to memories of the TLM-2.0 base protocol.
///
/// b_transport, DMI, debug transport: as in the base protocol; debug transport returns the bytes moved, all or 0.
/// nb_transport: BEGIN_REQ offers a request; END_REQ, by return (TLM_UPDATED) or later on the backward path, takes it;
/// BEGIN_RESP answers it and is completed by return (TLM_COMPLETED). Exclusion: no BEGIN_REQ before the last END_REQ.
/// Answers come in the order of the requests. A request is its initiator's, and stays where and what it is until
/// answered; the memory writes `data` of a read, `response` and `dmi_allowed`.
struct MemoryProtocol {
    using tlm_payload_type = MemoryRequest;
    using tlm_phase_type = tlm::tlm_phase;
};

}  // namespace tessera
