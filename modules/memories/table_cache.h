#pragma once
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/memories/banked_ports.h"
#include "modules/memories/line_cache.h"
#include "modules/memories/memory_server.h"
#include "modules/sockets/memory_port.h"
#include "modules/timing/ring.h"

namespace tessera {

/// A cache between the units and a table in off-chip memory, in designs with `timing.TABLE_cache_bytes`.
///
/// In:        requests, as a MemoryServer. Out: `table`, reads of whole lines.
/// Lines:     line_cache.h.
/// Lookup:    entries in order, any number per cycle; tags are banked like the data. An entry whose line is neither
///            present nor being filled begins a fill. Up to `fills` lines, and as many requests, are under way.
///            Requests are looked up and answered in order.
/// Timing:    a request whose entries have all arrived reads them from the cache's banks (banked_ports.h).
/// Busy:      while an answer is due; waiting for memory: while the oldest request waits for a line.
/// Functional mode: forwards to the table, bypassing the lines.
///
/// (Decision: between ports and table, so that neither the units nor the data path change; a unit has register stages
/// for the cycles of a miss (Timing::read_latency), since it would wait for each miss with fewer. Answers out of order
/// would need tags in the units. 80 to 206 bytes are fetched per finished triangle: at 64 bytes per cycle at least 1.3
/// to 3.2 cycles, whatever the latency.)
class TableCache : public MemoryServer {
  public:
    MemoryPort table;

    TableCache(const sc_core::sc_module_name& name, CycleScheduler& clock, const datapath::TableLayout& layout,
               const MemoryTiming& timing, const StallParameters& stalls);

    /// Call between runs when the table's content or columns have changed. Invalidates all lines.
    void lay_out(std::uint32_t columns) {
        ports_.lay_out(columns);
        cache_.clear();
    }

    /// Entries present or being filled at lookup; entries that began a fill.
    std::uint64_t hits() const { return hits_; }
    std::uint64_t fills() const { return table.requests(); }
    std::uint64_t bytes_fetched() const { return fills() * table.entry_bytes(); }
    std::uint64_t entries_read() const { return hits_ + fills(); }

    std::uint64_t occupied_cycles() const override { return ports_.occupied_cycles(); }
    std::string describe_contents() const override;
    void trace_signals(Signals& signals) const override;

  private:
    TableCache(const sc_core::sc_module_name& name, CycleScheduler& clock, const datapath::TableLayout& layout,
               const MemoryTiming& timing, const StallParameters& stalls, const CacheShape& shape);

    /// A request that has been looked up, in whole or in part.
    struct Gather {
        MemoryRequest* request = nullptr;
        unsigned looked_up = 0;  // number of entries
        std::uint32_t come = 0;  // bit k: entry k has arrived
        bool answered = false;

        bool complete() const { return come == (1u << request->count) - 1; }
    };

    std::uint64_t ready(const MemoryRequest&) const override;
    std::uint64_t serve(MemoryRequest& request, std::uint64_t cycle) override;
    void step() override;
    void look_up();
    void take_fills(std::uint64_t cycle);
    void send_fills();
    void take_entry(Gather& gather, unsigned entry, const LineCache::Line& line);
    void drop_answered();
    bool looking_up() const;
    std::uint64_t line_number(std::uint64_t address) const { return (address - base_) / line_bytes_; }

    void b_transport(int id, MemoryRequest& request, sc_core::sc_time& delay) override;
    bool get_direct_mem_ptr(int id, MemoryRequest& request, tlm::tlm_dmi& dmi) override;
    unsigned transport_dbg(int id, MemoryRequest& request) override;

    std::uint64_t base_;
    unsigned line_bytes_;
    LineCache cache_;
    BankedPorts ports_;
    Ring<Gather> gathers_;                 // in order of arrival
    Ring<std::uint64_t> to_fetch_;         // line numbers
    Ring<LineCache::Line*> on_their_way_;  // in the order of the requests
    std::uint64_t hits_ = 0;
};

}  // namespace tessera
