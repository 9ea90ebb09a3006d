#pragma once
#include <tlm_utils/multi_passthrough_target_socket.h>
#include <cstdint>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/datapath/parameters.h"

namespace tessera {

/// A memory that holds one table: on the base protocol, with byte addresses.
///
/// Address map: [layout.base, layout.base + layout.bytes()); entry (x, y) at layout.address(x, y), little endian.
/// Read by units (b_transport, DMI), written only by the host's debug transport before the run.
/// b_transport: adds `read_time` per entry. Errors: a write gives TLM_COMMAND_ERROR_RESPONSE, an address outside
/// TLM_ADDRESS_ERROR_RESPONSE, byte enables or streaming the TLM responses for those.
/// Capacity: one port; the functional mode does not arbitrate it.
class TableMemory : public sc_core::sc_module {
  public:
    tlm_utils::multi_passthrough_target_socket<TableMemory> socket{"socket"};

    TableMemory(const sc_core::sc_module_name& name, const datapath::TableLayout& layout,
                const sc_core::sc_time& read_time);

    const datapath::TableLayout& layout() const { return layout_; }

    /// Entries read by transactions; what DMI reads is counted by the reader.
    std::uint64_t transactions() const { return transactions_; }

  private:
    void b_transport(int id, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
    bool get_direct_mem_ptr(int id, tlm::tlm_generic_payload& payload, tlm::tlm_dmi& dmi);
    unsigned transport_dbg(int id, tlm::tlm_generic_payload& payload);
    bool covers(std::uint64_t address, std::uint64_t length) const;

    datapath::TableLayout layout_;
    sc_core::sc_time read_time_;
    std::vector<unsigned char> storage_;
    std::uint64_t transactions_ = 0;
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
