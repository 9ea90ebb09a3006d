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

/// A memory that holds one table, or the second side of such a memory: a dual-port memory has two sides, each with its
/// own ports, queue and statistics, so that readers of one side do not wait for the other's. Both share one storage;
/// the second counts as a copy, as every port does (stage/area.h). (Decision: with shared ports the Curvature Test and
/// Displace Vertex delay each other, in the paper's design by 3.3 cycles per triangle on half donut, 15.1 instead of
/// 11.8, by 0.3 on Crater Lake; and the schedule, which has no order between readers, could not check the design.)
///
/// Address map: [layout.base, layout.base + layout.bytes()); entry (x, y) at layout.address(x, y), little endian.
/// Off chip it extends to the end of its last line. Read by units, written only by the host's debug transport before
/// the run.
/// Timing: on chip banked_ports.h; for a table in off-chip memory, which a cache reads line by line (table_cache.h),
/// the channel shared by all off-chip memory. b_transport, DMI: the latency, once per entry.
/// Utilisation: modules/README.md, Accounting. (Decision: cycles in which a request is held up count, since bank
/// conflicts delay requests while most ports are idle.)
/// Errors: a write gives TLM_COMMAND_ERROR_RESPONSE, an address out of range TLM_ADDRESS_ERROR_RESPONSE.
/// Prompt (PromptMemory): on chip, with one reader, without stalls. The clock then does not call it: each request's cycles
/// follow from those of the requests before it.
class TableMemory : public MemoryServer, public PromptMemory {
  public:
    /// off_chip: used if the table has a cache.
    TableMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, const datapath::TableLayout& layout,
                const MemoryTiming& timing, const StallParameters& stalls, Channel* off_chip = nullptr);
    /// The second side of an on-chip memory, which the host fills through the first.
    TableMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, const TableMemory& first_side,
                const datapath::TableLayout& layout, const MemoryTiming& timing, const StallParameters& stalls);

    /// Sets the memory's area. entries_read: the most that one request reads.
    void set_area(int entry_bits, unsigned entries_read);

    /// Sets the table's columns between runs. Its base, entry size and the memory's capacity do not change.
    void lay_out(std::uint32_t columns) { ports_.lay_out(columns); }

    /// Entries read by transactions; reads through DMI are counted by the reader.
    std::uint64_t transactions() const { return transactions_; }
    /// Port slots, or cycles of the channel.
    std::uint64_t slots_taken() const { return channel_ != nullptr ? channel_cycles_ : ports_.slots_taken(); }
    std::uint64_t slots_per_cycle() const { return channel_ != nullptr ? 1 : ports_.slots_per_cycle(); }

    /// Requests were held up in more cycles than the busiest bank's ports were in use.
    bool delays_more_than_it_serves() const { return cycles_held_up() > ports_.occupied_cycles(); }
    std::uint64_t occupied_cycles() const override {
        return channel_ != nullptr ? channel_cycles_ : std::max(ports_.occupied_cycles(), cycles_held_up());
    }
    void trace_signals(Signals& signals) const override;

    bool is_prompt() override;
    bool read_promptly(const std::uint64_t* addresses, unsigned count, unsigned entry_bytes, std::uint64_t* entries,
                       std::uint64_t offered, Times& times) override;

  private:
    TableMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, std::shared_ptr<Storage> storage,
                const datapath::TableLayout& layout, const MemoryTiming& timing, const StallParameters& stalls,
                Channel* off_chip);
    std::uint64_t ready(const MemoryRequest& request) const override;
    std::uint64_t serve(MemoryRequest& request, std::uint64_t cycle) override;
    void b_transport(int id, MemoryRequest& request, sc_core::sc_time& delay) override;
    bool get_direct_mem_ptr(int id, MemoryRequest& request, tlm::tlm_dmi& dmi) override;
    unsigned transport_dbg(int, MemoryRequest& request) override { return move(*storage_, request); }
    void read(MemoryRequest& request);

    std::shared_ptr<Storage> storage_;  // of both sides
    BankedPorts ports_;
    const std::uint64_t waiting_requests_, copied_entries_, address_bits_;  // for the area
    Channel* channel_;                                                      // null: on chip
    std::uint64_t channel_cycles_ = 0;
    std::uint64_t transactions_ = 0;
    std::uint64_t last_address_ = 0;  // of the request served last
    unsigned last_entries_ = 0;
    unsigned last_entry_bytes_ = 0;
    // Of requests read promptly:
    const bool may_be_prompt_;
    std::vector<std::uint64_t> served_;  // the cycles in which the last ones left the buffer, as many as it holds
    std::size_t oldest_served_ = 0;
    std::uint64_t last_served_ = 0;
    Ring<std::uint64_t> answers_due_;
    std::uint64_t last_answer_ = 0;
};

/// The displacement map: one unsigned code per texel. Read by Displace Vertex and, with Formats::codes, by the Summed
/// Height Test. The Curvature Test reads its second side.
class DisplacementMap : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

/// The normal map: three signed components per texel, in the tangent frame. Read by the Normal Test, in the
/// family design also by Displace Vertex.
class NormalMap : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

/// The table of the design's height test (height_table_spec). Read by HeightTestUnit.
class HeightTable : public TableMemory {
  public:
    using TableMemory::TableMemory;
};

}  // namespace tessera
