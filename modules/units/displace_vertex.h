#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/memory/memory_port.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"
#include "modules/timing.h"
#include "modules/unit/table_stage.h"

namespace tessera {

/// Displace Vertex (paper figure 7): P' = P + (S * d(t) + bias) * N, the one added long-latency unit.
///
/// In:   edges with new_vertex[k].position, .mean_normal, .texture; vertices of a base triangle; normals pass unchanged.
/// Out:  new_vertex[k].displaced; vertices[k].displaced.
/// Memory: one read of the displacement map per vertex or edge.
/// Arithmetic: normalise (the pipeline's existing unit), multiply, round, multiply-accumulate, saturate (counted).
/// Timing: one vertex, normal or edge per interval; latency 6 plus the map read, interval 1 by default.
/// Waits for the displacement map; held back by Transform.
class DisplaceVertex : public TableStage<DisplaceVertex, TableItem> {
  public:
    StreamInput<Work> from_calculate_new_p{"from_calculate_new_p"};
    StreamOutput<Work> to_transform{"to_transform"};
    MemoryPort displacement_map;

    DisplaceVertex(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                   const Timing& timing, bool use_direct_memory);

    const datapath::Saturations& saturations() const { return saturations_; }

  private:
    friend class TableStage<DisplaceVertex, TableItem>;
    void b_transport(Work& work, sc_core::sc_time& delay);
    unsigned begin(TableItem& item);
    void ask(TableItem& item, unsigned k);
    void receive(TableItem& item, unsigned k);
    void trace_item(Signals& signals, const TableItem& item) const;
    void trace_answered(Signals& signals, const TableItem& item) const;

    std::uint64_t address(const datapath::TexCoord& t) const;
    void displace_vertex(datapath::Vertex& vertex, std::uint64_t code);
    void displace_edge(datapath::NewVertex& made, std::uint64_t code);

    const datapath::Registers& registers_;
    datapath::Saturations saturations_;
};

}  // namespace tessera
