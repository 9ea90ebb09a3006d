#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Calculate New P (paper figure 7): the midpoint of each edge's two positions.
///
/// In:   a pass with its triangle. Out: new_vertex[k].position = (P_i + P_j) >> 1, likewise t and, not yet of unit
///       length, N: Displace Vertex needs all three. (Decision: t_ij and the mean normal are formed here as well as
///       in Tessellation Tests, so that the two branches need no stream between them; Pass or Tessellate checks that
///       they agree.) A base triangle's own vertices and vertices' normals pass unchanged.
/// Arithmetic: add, arithmetic shift right by 1.
/// Timing: one vertex or normal per interval; latency 1, interval 1 by default. Capacity: its pipeline.
/// Waits for nothing but its input; held back by Displace Vertex.
class CalculateNewP : public sc_core::sc_module {
  public:
    StreamTarget<CalculateNewP, datapath::TrianglePass> from_get_triangle{"from_get_triangle"};
    StreamInitiator<CalculateNewP, datapath::TrianglePass> to_displace_vertex{"to_displace_vertex"};

    CalculateNewP(const sc_core::sc_module_name& name, const Timing& timing);

    static void process(datapath::TrianglePass& pass);

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);

    sc_core::sc_time latency_;
};

}  // namespace tessera
