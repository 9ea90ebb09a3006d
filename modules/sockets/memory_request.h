#pragma once
#include <array>
#include <cstdint>
#include <tlm>

#include "modules/datapath/rectangle.h"

namespace tessera {

/// A request to read or write entries of one size, each at its own address. The corners of a rectangle, which occupy a
/// port one after another, are one request: a handshake for each would dominate simulation time.
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

/// A memory that can tell, when a request is made, when it will be accepted and answered. Its single reader then needs
/// no phases. The cycles are those of the protocol below.
class PromptMemory {
  public:
    struct Times {
        std::uint64_t accepted, answered;
    };
    /// Ask after elaboration.
    virtual bool is_prompt() = 0;
    /// Reads entries, zero-extended, by a request that is offered in cycle `offered`: no earlier than that in which the
    /// previous one is accepted. Returns false if an address is out of range.
    virtual bool read_promptly(const std::uint64_t* addresses, unsigned count, unsigned entry_bytes,
                               std::uint64_t* entries, std::uint64_t offered, Times& times) = 0;

  protected:
    ~PromptMemory() = default;
};

/// The protocol between a unit's MemoryPort and a MemoryServer. It has its own traits class, because a memory of the
/// base protocol, which reads one address, would answer a gather wrongly, without a message; so the binding does not
/// compile. base_protocol_bridge.h connects to memories of the TLM-2.0 base protocol.
///
/// b_transport, DMI, debug transport: as in the base protocol; debug transport returns the bytes moved, all or 0.
/// nb_transport: BEGIN_REQ offers a request; END_REQ, by return (TLM_UPDATED) or later on the backward path, accepts
/// it; BEGIN_RESP answers it and is completed by return (TLM_COMPLETED). Exclusion rule: no BEGIN_REQ before the last
/// END_REQ. Requests are answered in order. The initiator owns a request, which stays in place and unchanged until
/// answered; the memory writes `data` of a read, `response` and `dmi_allowed`.
struct MemoryProtocol {
    using tlm_payload_type = MemoryRequest;
    using tlm_phase_type = tlm::tlm_phase;
};

}  // namespace tessera
