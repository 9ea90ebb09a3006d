#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"

namespace tessera {

/// Transform (paper figure 7): world to screen; the pipeline's existing unit, OpenGL's clipping, perspective and
/// viewport application.
///
/// In:   a pass with displaced positions of its new vertices; vertices[k].displaced_normal where new_normals has bit k.
/// Out:  new_vertex[k].screen; vertices[k].screen where new_vertices has bit k; vertices[k].screen_normal where
///       new_normals has bit k. A base triangle's screen positions also go to the View Test, which waits for them.
/// Arithmetic: 9 multiplications (position or normal); for a position a reciprocal (a table and 4 multiplications) and 2 more, saturate (counted).
/// Timing: one vertex or normal per interval; latency 20, interval 1 by default. Capacity: its pipeline.
/// Waits for nothing but its input; held back by Pass or Tessellate.
class Transform : public sc_core::sc_module {
  public:
    StreamTarget<Transform, datapath::TrianglePass> from_displace_vertex{"from_displace_vertex"};
    StreamInitiator<Transform, datapath::TrianglePass> to_pass_or_tessellate{"to_pass_or_tessellate"};
    StreamInitiator<Transform, datapath::TrianglePass> to_view_test{"to_view_test"};

    Transform(const sc_core::sc_module_name& name, const datapath::Registers& registers,
              const Timing& timing);

    const datapath::Saturations& saturations() const { return saturations_; }
    std::uint64_t positions() const { return positions_; }
    std::uint64_t normals() const { return normals_; }

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);

    const datapath::Registers& registers_;
    sc_core::sc_time latency_;
    datapath::Saturations saturations_;
    std::uint64_t positions_ = 0;
    std::uint64_t normals_ = 0;
};

}  // namespace tessera
