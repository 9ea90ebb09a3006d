#pragma once
#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm>

namespace tessera {

/// Protocol of the streams between units: not memory-mapped, so a traits class of its own. The payload is the work
/// item itself; phases are TLM-2.0's. The producer initiates; the consumer holds back by not accepting.
///
/// b_transport (functional mode): the consumer has done its work, and all that follows from it, on return; `delay` is
/// added to, never overwritten. The payload is the producer's; it may be written only in the fields that the
/// consumer's header names.
template <class Payload>
struct Stream {
    using tlm_payload_type = Payload;
    using tlm_phase_type = tlm::tlm_phase;
};

/// A unit's output. BUSWIDTH means nothing on a stream; widths follow from the formats.
template <class Unit, class Payload>
using StreamInitiator = tlm_utils::simple_initiator_socket<Unit, 32, Stream<Payload>>;

/// A unit's input.
template <class Unit, class Payload>
using StreamTarget = tlm_utils::passthrough_target_socket<Unit, 32, Stream<Payload>>;

}  // namespace tessera
