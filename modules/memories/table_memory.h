#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "modules/memories/banked_ports.h"
#include "modules/memories/channel.h"
#include "modules/memories/memory_server.h"
#include "modules/memories/storage.h"

namespace tessera {

/// A memory that holds one table, or the second side of one: a dual-port memory has two sides, each with ports, a queue
/// and figures of its own, so that neither side's readers wait for the other's. The bits are there once.
///
/// Address map: [layout.base, layout.base + layout.bytes()); entry (x, y) at layout.address(x, y), little endian.
/// Off chip it reaches to the end of its last line. Read by units, written only by the host's debug transport before
/// the run.
/// Timing: on chip banked_ports.h; of a table in off-chip memory, which a cache reads line by line (table_cache.h),
/// the channel that all off-chip memory shares. b_transport, DMI: the latency, once a request.
/// Utilisation: the share of the busiest bank's port slots taken, or of cycles in which a request was held up,
/// whichever is greater: bank conflicts delay requests while most ports are idle.
/// Errors: a write gives TLM_COMMAND_ERROR_RESPONSE, an address outside TLM_ADDRESS_ERROR_RESPONSE.
class TableMemory : public MemoryServer {
  public:
    /// off_chip: used if the table has a cache.
    TableMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, const datapath::TableLayout& layout,
                const MemoryTiming& timing, const StallParameters& stalls, Channel* off_chip = nullptr);
    /// The second side of a memory on chip, which the host fills through the first.
    TableMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, const TableMemory& first_side,
                const datapath::TableLayout& layout, const MemoryTiming& timing, const StallParameters& stalls);

    /// Between runs: the table's columns from now on. Its base, the size of its entries and the memory's capacity stay.
    void lay_out(std::uint32_t columns) { ports_.lay_out(columns); }

    /// Entries read by transactions; reads through DMI are counted by the reader.
    std::uint64_t transactions() const { return transactions_; }
    /// Port slots, or cycles of the channel.
    std::uint64_t slots_taken() const { return channel_ != nullptr ? channel_cycles_ : ports_.slots_taken(); }
    std::uint64_t slots_per_cycle() const { return channel_ != nullptr ? 1 : ports_.slots_per_cycle(); }

    std::uint64_t occupied_cycles() const override {
        return channel_ != nullptr ? channel_cycles_ : std::max(ports_.occupied_cycles(), cycles_held_up());
    }
    void trace_signals(Signals& signals) const override;

    /// The figures of a run in which no request came (modules/conductor.h).
    struct Figures {
        std::vector<std::uint64_t> bank_slots;  ///< port slots taken of each bank
        std::uint64_t entries = 0;
        std::uint64_t cycles_held_up = 0;
    };
    void assign(const Figures& figures);

  private:
    std::uint64_t ready(const MemoryRequest& request) const override;
    std::uint64_t serve(MemoryRequest& request, std::uint64_t cycle) override;
    void b_transport(int id, MemoryRequest& request, sc_core::sc_time& delay) override;
    bool get_direct_mem_ptr(int id, MemoryRequest& request, tlm::tlm_dmi& dmi) override;
    unsigned transport_dbg(int, MemoryRequest& request) override { return move(*storage_, request); }
    void read(MemoryRequest& request);

    std::shared_ptr<Storage> storage_;  // of both sides
    BankedPorts ports_;
    Channel* channel_;  // null: on chip
    std::uint64_t channel_cycles_ = 0;
    std::uint64_t transactions_ = 0;
    std::uint64_t last_address_ = 0;  // of the request served last
    unsigned last_entries_ = 0;
    unsigned last_entry_bytes_ = 0;
};

/// The displacement map: one unsigned code per texel. Read by Displace Vertex, with Formats::codes also by Summed
/// Height Test. The Curvature Test reads its second side.
class DisplacementMap : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

/// The normal map: three signed components per texel, in the tangent frame. Read by Normal Test.
class NormalMap : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

/// The Summed Height Table: (width + 1) x (height + 1) sums modulo 2^n; or the Rank Table: an entry a texel of the base
/// mesh's lattice. Read by Summed Height Test or Rank Test.
class HeightTable : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

}  // namespace tessera
