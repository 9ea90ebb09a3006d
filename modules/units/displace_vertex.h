#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/memory/memory_port.h"
#include "modules/unit/stage.h"

namespace tessera {

/// Displace Vertex (paper figure 7): P' = P + (S * d(t) + bias) * N, the one added long-latency unit.
///
/// In:   edges with new_vertex[k].position, .mean_normal, .texture; vertices of a base triangle; normals pass unchanged.
/// Out:  new_vertex[k].displaced; vertices[k].displaced.
/// Memory: one read of the displacement map per vertex or edge.
/// Arithmetic: normalise (the pipeline's existing unit), multiply, round, multiply-accumulate, saturate (counted).
/// Timing: one vertex, normal or edge per interval; latency 6 plus the map read, interval 1 by default.
/// Waits for the displacement map; held back by Transform.
class DisplaceVertex final : public Stage<Work> {
  public:
    StreamInput<Work> from_calculate_new_p{"from_calculate_new_p"};
    StreamOutput<Work> to_transform{"to_transform"};
    MemoryPort displacement_map;

    DisplaceVertex(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                   const Timing& timing, bool use_direct_memory);

    const datapath::Saturations& saturations() const { return saturations_; }

  private:
    void reads(const Work& part, Reads& reads) const override;
    Work process(const Work& part, const Entries& codes) override;
    void trace_started(Signals& signals, const Work& part) const override;
    void trace_processed(Signals& signals, const Work& part, const Work& result) const override;

    const datapath::Registers& registers_;
    datapath::Saturations saturations_;
};

}  // namespace tessera
