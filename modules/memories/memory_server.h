#pragma once
#include <tlm_utils/multi_passthrough_target_socket.h>
#include <tlm_utils/passthrough_target_socket.h>
#include <cstdint>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/memories/storage.h"
#include "modules/sockets/memory_request.h"
#include "modules/stage/unit.h"
#include "modules/timing/pending_item.h"
#include "modules/timing/random_stalls.h"
#include "modules/timing/ring.h"

namespace tessera {

/// Accepts, queues and answers a memory's requests. A derived memory moves the data and decides when a request is
/// served (banked_ports.h, channel.h).
///
/// In:        requests (memory_request.h), from several ports. Timed mode: nb_transport; violations of the protocol are
///            SC_ERRORs. Functional mode: b_transport and DMI, not arbitrated.
///            `host`: TLM-2.0 base protocol, debug transport only, for the preload.
/// Capacity:  `buffer` requests wait to be served. Beyond that END_REQ is withheld, and requests held back are accepted
///            round-robin by port.
/// Order:     served and answered in order of arrival; within a cycle, in the order of the units.
/// Busy:      while an answer is due. Held up: cycles in which the oldest request in the buffer could not be served.
class MemoryServer : public Unit {
  public:
    tlm_utils::multi_passthrough_target_socket_optional<MemoryServer, 32, MemoryProtocol> socket{"socket"};
    tlm_utils::passthrough_target_socket_optional<MemoryServer> host{"host"};

    ~MemoryServer() override;

    std::uint64_t cycles_held_up() const { return cycles_held_up_; }
    /// No unit's port leads here: what the host writes is an SC_ERROR from now on.
    void has_no_reader() { no_reader_ = true; }
    std::string describe_contents() const override;

  protected:
    MemoryServer(const sc_core::sc_module_name& name, CycleScheduler& clock, unsigned buffer,
                 const StallParameters& stalls);

    /// The first cycle in which `request`, the oldest in the buffer, can be served; a past cycle means at once; ~0: not
    /// known, the derived memory wakes itself.
    virtual std::uint64_t ready(const MemoryRequest& request) const = 0;
    /// Moves the data, sets the response, and returns the cycle of the answer; ~0: finish() will set it.
    virtual std::uint64_t serve(MemoryRequest& request, std::uint64_t cycle) = 0;
    virtual bool busy(std::uint64_t) const { return !answers_.empty(); }

    virtual void b_transport(int id, MemoryRequest& request, sc_core::sc_time& delay) = 0;
    virtual bool get_direct_mem_ptr(int, MemoryRequest&, tlm::tlm_dmi&) { return false; }
    virtual unsigned transport_dbg(int id, MemoryRequest& request) = 0;

    void step() override;
    /// The answer to a served request is due in `cycle`.
    void finish(const MemoryRequest& request, std::uint64_t cycle);

    /// Reads or writes the entries and returns the bytes moved; 0: neither read nor write, or an address out of range.
    static unsigned move(Storage& storage, MemoryRequest& request);
    /// Does the same, and sets the response.
    static void access(Storage& storage, MemoryRequest& request, bool may_write);

    /// For requests that do not pass through the queue.
    void count_held_up(std::uint64_t cycles) { cycles_held_up_ += cycles; }
    void show_waiting(Signals& signals) const;
    bool held_up() const { return held_up_; }

  private:
    struct Served {
        MemoryRequest* request = nullptr;
        int id = 0;  // of the port
        std::uint64_t answer_at = ~std::uint64_t{0};
    };

    tlm::tlm_sync_enum nb_transport_fw(int id, MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay);
    unsigned host_transport_dbg(tlm::tlm_generic_payload& payload);
    void admit(std::uint64_t cycle);
    void answer(const Served& served);

    RandomStalls stalls_;
    std::vector<PendingItem<MemoryRequest>> held_back_;  // by port, for ports that have made requests
    std::size_t turn_ = 0;                               // the next port, round-robin
    std::size_t waiting_ = 0;                            // number of requests held back
    bool no_reader_ = false;
    Ring<Served> queue_;
    Ring<Served> answers_;  // due; grows to the number of requests that the ports have under way
    std::uint64_t held_up_since_ = 0;
    bool held_up_ = false;
    std::uint64_t cycles_held_up_ = 0;
};

}  // namespace tessera
