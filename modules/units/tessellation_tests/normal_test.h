#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/memory/memory_port.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Normal Test (paper figure 8, 2.2, 3.1.4): Calculate New N, Normalise, Bump, and the comparison of the displaced
/// normals.
///
/// In:   N, T, N' of both ends; edges[k].texture. For a base triangle N, T, t of its own vertices.
/// Out:  edges[k].normal = N_ij, .tangent = T_ij, .displaced_normal = N'_ij, normal_bit of edges[k].tests;
///       vertices[k].displaced_normal where new_vertices has bit k (a base triangle's corners are bumped first).
/// Memory: one read of the normal map per vertex.
/// Arithmetic: add, shift by 1; the pipeline's existing normalise and bump units; six absolute differences and
///       compares, one OR.
/// Timing: one vertex per interval; latency 9 plus the map read, interval 1 by default. Waits for Calculate New U and
/// the normal map.
class NormalTest : public sc_core::sc_module {
  public:
    StreamTarget<NormalTest, datapath::TrianglePass> input{"input"};
    MemoryPort normal_map;

    NormalTest(const sc_core::sc_module_name& name, const datapath::Registers& registers,
               const Timing& timing, bool use_direct_memory);

    const datapath::Saturations& saturations() const { return saturations_; }

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);
    datapath::Direction bumped(const datapath::Direction& n, const datapath::Direction& t, int handedness,
                               const datapath::TexCoord& texture, sc_core::sc_time& delay);

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
    datapath::Saturations saturations_;
};

}  // namespace tessera
