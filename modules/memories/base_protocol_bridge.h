#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <cstdint>
#include <deque>
#include <memory>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/memories/memory_server.h"

namespace tessera {

/// Bridge from the memory protocol (memory_request.h) to a memory of the TLM-2.0 base protocol, in place of a table
/// memory or of off-chip memory.
///
/// In:        requests, as a MemoryServer. Out: `to_memory`, an ordinary read or write for each entry.
/// Interval:  one entry per cycle, in order, so that a memory as fast as a table gives the table's cycle counts; each
///            entry only after END_REQ of the one before.
/// Latency:   that of the memory behind the bridge, rounded up to whole cycles.
/// Accepts:   END_REQ by return, later, or implied by the answer; an answer by return (TLM_COMPLETED, or BEGIN_RESP, to
///            which END_RESP is sent at once) or later; answers in any order. Requests are answered in
///            order. A response other than OK becomes the request's.
/// Functional mode: b_transport for each entry; DMI and debug transport are passed on.
/// Limit:     Design::answer_cycles, of the ports joined to it.
/// Attaches itself to the clock.
class BaseProtocolBridge : public MemoryServer, public tlm::tlm_mm_interface {
  public:
    tlm_utils::simple_initiator_socket<BaseProtocolBridge> to_memory{"to_memory"};

    /// buffer: requests that wait while the entries of one are sent, at least 1.
    BaseProtocolBridge(const sc_core::sc_module_name& name, CycleScheduler& clock, unsigned buffer,
                       const StallParameters& stalls = {});
    ~BaseProtocolBridge() override;

    /// Entries sent, one per cycle.
    std::uint64_t occupied_cycles() const override { return entries_sent_; }
    std::string describe_contents() const override;

  private:
    struct Entry;  // under way
    struct Gather {
        MemoryRequest* request = nullptr;
        unsigned unanswered = 0;
        std::uint64_t answer_at = 0;
    };

    std::uint64_t ready(const MemoryRequest&) const override;
    std::uint64_t serve(MemoryRequest& request, std::uint64_t cycle) override;
    void step() override;
    void send_entry(std::uint64_t cycle);
    void answered(Entry& entry, std::uint64_t cycle);
    tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                       sc_core::sc_time& delay);
    void invalidate_direct_mem_ptr(sc_dt::uint64 start, sc_dt::uint64 end);
    Entry& unused_entry();
    void free(tlm::tlm_generic_payload* payload) override;

    void b_transport(int id, MemoryRequest& request, sc_core::sc_time& delay) override;
    bool get_direct_mem_ptr(int id, MemoryRequest& request, tlm::tlm_dmi& dmi) override;
    unsigned transport_dbg(int id, MemoryRequest& request) override;

    std::vector<std::unique_ptr<Entry>> entries_;
    std::vector<Entry*> unused_;   // those of entries_ that are free
    std::deque<Gather> gathers_;   // begun and not answered, oldest first
    unsigned sent_ = 0;            // entries sent of the newest gather
    bool sending_ = false;         // not all of its entries are sent
    Entry* on_offer_ = nullptr;    // its END_REQ has not arrived
    std::uint64_t next_send_ = 0;  // cycle
    std::uint64_t entries_sent_ = 0;
};

}  // namespace tessera
