#pragma once
#include <systemc>
#include <tlm>

#include "modules/timing/cycle_scheduler.h"

namespace tessera {

/// Protocol of the streams between units. Streams are not memory-mapped, hence a traits class of their own. The payload
/// is the item itself (items.h); the phases are those of TLM-2.0; the producer is the initiator (StreamOutput), the
/// consumer the target (StreamInput).
///
/// b_transport (functional mode): on return the consumer and everything downstream have finished; `delay` is added to,
/// never overwritten. The producer owns the payload, which is not written.
///
/// nb_transport (timed mode), two phases: BEGIN_REQ offers one item; END_REQ, by return (TLM_UPDATED) or later on the
/// backward path, means that the consumer has accepted it. Withholding END_REQ is back-pressure. Exclusion rule: no
/// second BEGIN_REQ before END_REQ. The payload stays unchanged until END_REQ; the consumer copies it. (Decision: the
/// fewest phases that model exclusion and back-pressure; a memory's BEGIN_RESP adds latency. Both ends check each other
/// in every build, for two compares.)
/// An output bound to a StreamInput with nothing in between calls `transport` and `offer` instead of b_transport and
/// nb_transport_fw: the same rules, without TLM's interfaces and arguments.
template <class Payload>
struct Stream {
    using tlm_payload_type = Payload;
    using tlm_phase_type = tlm::tlm_phase;
};

/// Reports a violation of the protocol: an SC_ERROR that names the socket, the rule and, with a clock, the cycle.
[[noreturn]] void stream_protocol_error(const char* socket, const char* rule, const CycleScheduler* clock = nullptr);

/// The module at the other end of a bound socket or port, if the module itself or one of its sockets implements the
/// interface there; else null (TLM's convenience sockets).
const sc_core::sc_object* module_behind(const sc_core::sc_interface* interface);

}  // namespace tessera
