#pragma once
#include <tlm_utils/multi_passthrough_target_socket.h>
#include <cstdint>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/memory/gather_extension.h"
#include "modules/stream/random_stalls.h"
#include "modules/timing.h"
#include "modules/unit/unit.h"

namespace tessera {

/// A memory that holds one table: on the base protocol, with byte addresses.
///
/// Address map: [layout.base, layout.base + layout.bytes()); entry (x, y) at layout.address(x, y), little endian.
/// Read by units, written only by the host's debug transport before the run. A read is of one entry, or gathers
/// several (gather_extension.h).
/// Errors: a write gives TLM_COMMAND_ERROR_RESPONSE, an address outside TLM_ADDRESS_ERROR_RESPONSE, byte enables or
/// streaming the TLM responses for those.
///
/// b_transport, DMI (functional mode): the latency for each entry, not arbitrated.
/// nb_transport (timed mode): requests are served in order of arrival; those of one cycle in the order of units. Entry k
/// is at bank k mod banks; each bank has `ports` ports, each port takes an entry's address every
/// ceil(entry bytes / width) cycles, and its data comes `latency` cycles after the last of these. A request is served from the cycle on in which each bank it reads has a port free, and answered (BEGIN_RESP) when its last entry
/// has come. Capacity: `buffer` requests waiting; beyond that END_REQ is withheld. Busy: from then until the answer.
/// Utilisation: the share of the busiest bank's port slots that were taken, or of the cycles in which a request waited
/// for a port, whichever is more: banks in conflict hold requests up with most of their ports idle.
class TableMemory : public Unit {
  public:
    tlm_utils::multi_passthrough_target_socket<TableMemory> socket{"socket"};

    TableMemory(const sc_core::sc_module_name& name, Clock& clock, const datapath::TableLayout& layout,
                const MemoryTiming& timing, const StallParameters& stalls);

    /// Entries read by transactions; what DMI reads is counted by the reader.
    std::uint64_t transactions() const { return transactions_; }
    /// Port slots taken: entries times the cycles a port needs for one.
    std::uint64_t slots_taken() const { return slots_taken_; }
    /// Port slots a cycle, of all banks.
    std::uint64_t slots_per_cycle() const { return std::uint64_t{timing_.ports} * timing_.banks; }
    /// Cycles in which a request in the buffer waited for a port.
    std::uint64_t cycles_held_up() const { return cycles_held_up_; }

    std::string holds() const override {
        return listed(count_of(std::size_t{queued_} + answers_, "request"),
                      waiting_at_doors_ == 0 ? "" : std::to_string(waiting_at_doors_) + " at its doors");
    }
    std::uint64_t occupied_cycles() const override;
    void show(Signals& signals) const override;

  private:
    struct Request {
        tlm::tlm_generic_payload* payload = nullptr;
        const GatherExtension* gather = nullptr;
        int id = 0;
        std::uint64_t answer_at = 0;
    };

    void b_transport(int id, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
    tlm::tlm_sync_enum nb_transport_fw(int id, tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                       sc_core::sc_time& delay);
    bool get_direct_mem_ptr(int id, tlm::tlm_generic_payload& payload, tlm::tlm_dmi& dmi);
    unsigned transport_dbg(int id, tlm::tlm_generic_payload& payload);
    void step() override;
    void admit(std::uint64_t cycle);
    void serve(const Request& request, std::uint64_t cycle);
    std::uint64_t take_slots(const tlm::tlm_generic_payload& payload, const GatherExtension* gather,
                             unsigned count, std::uint64_t cycle);
    std::size_t bank_of(std::uint64_t address) const {
        return (address - layout_.base) / layout_.entry_bytes % timing_.banks;
    }
    std::uint64_t* free_port(std::size_t bank);
    std::uint64_t when_served(const Request& request);
    void read(tlm::tlm_generic_payload& payload, const GatherExtension* gather);
    bool covers(std::uint64_t address, std::uint64_t length) const;

    datapath::TableLayout layout_;
    MemoryTiming timing_;
    unsigned slots_per_entry_;
    std::vector<unsigned char> storage_;
    std::uint64_t transactions_ = 0;

    std::vector<Request> at_the_door_;  // by initiator; its END_REQ is withheld
    std::vector<std::uint64_t> door_opens_;
    std::size_t door_turn_ = 0;
    std::size_t waiting_at_doors_ = 0;
    RandomStalls stalls_;
    std::vector<Request> queue_;  // a ring
    std::size_t queue_first_ = 0;
    std::size_t queued_ = 0;
    bool one_by_one_;                        // one bank whose ports take an entry a cycle: the quick way
    std::uint64_t next_slot_ = 0;            // then, the first free: cycle * ports + port
    std::vector<std::uint64_t> port_free_;   // else, bank by bank: the cycle from which the port is free
    std::vector<std::uint64_t> bank_slots_;  // and how many were taken
    std::vector<Request> answer_ring_;       // served, not yet answered, in order
    std::size_t answer_first_ = 0;
    std::size_t answers_ = 0;
    std::uint64_t held_up_since_ = 0;
    bool held_up_ = false;  // the first request in the queue waits for a port
    std::uint64_t cycles_held_up_ = 0;
    std::uint64_t slots_taken_ = 0;
    std::uint64_t last_address_ = 0;
};

/// The displacement map: one unsigned code per texel. Read by Displace Vertex.
class DisplacementMap : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

/// The normal map: three signed components per texel, in the tangent frame. Read by Normal Test.
class NormalMap : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

/// The Summed Height Table: (width + 1) x (height + 1) sums modulo 2^n. Read by Summed Height Test.
class SummedHeightTable : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

}  // namespace tessera
