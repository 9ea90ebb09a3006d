#pragma once
#include <tlm_utils/multi_passthrough_target_socket.h>
#include <cstdint>
#include <deque>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/memory/storage.h"
#include "modules/stream/random_stalls.h"
#include "modules/unit/pending_item.h"
#include "modules/unit/ring.h"
#include "modules/unit/unit.h"

namespace tessera {

/// What every memory does with requests: takes, queues and answers them. A derived memory moves the data and decides
/// when a request is served (banked_ports.h, channel.h).
///
/// Protocol:  TLM-2.0 base protocol, several initiators. nb_transport (timed mode): BEGIN_REQ, END_REQ, BEGIN_RESP, which
///            the initiator completes by return. Breaches are SC_ERRORs. b_transport, DMI (functional mode): not arbitrated.
/// Capacity:  `buffer` requests wait to be served. Beyond that, END_REQ is withheld; initiators of which a request
///            is held back take turns.
/// Order:     served in order of arrival, those of one cycle in the order of the initiators' units; answered in that order.
/// Busy:      while an answer is due. Utilisation: what the memory's arbiter counts, or the share of cycles in which
///            a request in the buffer could not be served, whichever is more.
class MemoryServer : public Unit {
  public:
    tlm_utils::multi_passthrough_target_socket<MemoryServer> socket{"socket"};

    /// Cycles in which a request in the buffer could not be served.
    std::uint64_t cycles_held_up() const { return cycles_held_up_; }

    std::string holds() const override;

  protected:
    using Payload = tlm::tlm_generic_payload;

    MemoryServer(const sc_core::sc_module_name& name, Clock& clock, unsigned buffer,
                 const StallParameters& stalls);

    /// The first cycle in which `payload`, the oldest in the buffer, can be served; a past one: at once.
    virtual std::uint64_t ready(const Payload& payload) const = 0;
    /// Moves the data, sets the response, and returns the cycle of the answer.
    virtual std::uint64_t serve(Payload& payload, std::uint64_t cycle) = 0;
    virtual bool busy(std::uint64_t) const { return !answers_.empty(); }

    virtual void b_transport(int id, Payload& payload, sc_core::sc_time& delay) = 0;
    virtual bool get_direct_mem_ptr(int, Payload&, tlm::tlm_dmi&) { return false; }
    virtual unsigned transport_dbg(int id, Payload& payload) = 0;

    /// Reads or writes the payload's bytes and returns their number; 0: neither is meant, or not all are there.
    static unsigned move(Storage& storage, Payload& payload);
    void show_waiting(Signals& signals) const;
    bool held_up() const { return held_up_; }

  private:
    struct Request {
        Payload* payload = nullptr;
        int id = 0;  // of the initiator
        std::uint64_t answer_at = 0;
    };

    tlm::tlm_sync_enum nb_transport_fw(int id, Payload& payload, tlm::tlm_phase& phase,
                                       sc_core::sc_time& delay);
    void step() override;
    void admit(std::uint64_t cycle);
    void answer(const Request& request);

    RandomStalls stalls_;
    std::vector<PendingItem<Payload>> held_back_;  // by initiator, as far as they have made requests
    std::size_t turn_ = 0;                         // of these, the next to be let in
    std::size_t waiting_ = 0;                      // how many of these there are
    Ring<Request> queue_;
    std::deque<Request> answers_;  // due; as many as the initiators have under way
    std::uint64_t held_up_since_ = 0;
    bool held_up_ = false;  // the oldest request in the buffer can not be served yet
    std::uint64_t cycles_held_up_ = 0;
};

}  // namespace tessera
