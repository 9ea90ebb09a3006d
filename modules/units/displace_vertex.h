#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/memory/memory_port.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Displace Vertex (paper figure 7): P' = P + (S * d(t) + bias) * N, the one added long-latency unit.
///
/// In:   a pass with new_vertex[k].position, .mean_normal, .texture, and for a base triangle its own vertices.
/// Out:  new_vertex[k].displaced; vertices[k].displaced where new_vertices has bit k.
/// Memory: one read of the displacement map per vertex.
/// Arithmetic: normalise (the pipeline's existing unit), multiply, round, multiply-accumulate, saturate (counted).
/// Timing: one vertex per interval; latency 6 plus the map read, interval 1 by default. Capacity: its pipeline.
/// Waits for the displacement map; held back by Transform.
class DisplaceVertex : public sc_core::sc_module {
  public:
    StreamTarget<DisplaceVertex, datapath::TrianglePass> from_calculate_new_p{"from_calculate_new_p"};
    StreamInitiator<DisplaceVertex, datapath::TrianglePass> to_transform{"to_transform"};
    MemoryPort displacement_map;

    DisplaceVertex(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                   const Timing& timing, bool use_direct_memory);

    const datapath::Saturations& saturations() const { return saturations_; }

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);
    datapath::Position displaced(const datapath::Position& p, const datapath::Direction& n,
                                 const datapath::TexCoord& t, sc_core::sc_time& delay);

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
    datapath::Saturations saturations_;
};

}  // namespace tessera
