#pragma once
#include <cstdint>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/stage/stage.h"

namespace tessera {

/// Transform (paper figure 7): world to screen; the pipeline's existing unit, OpenGL's clipping, perspective and
/// viewport application.
///
/// In:   DisplacedPoint. Out: ScreenPoint: for an edge or vertex with P's, for a normal with N's in place of N; in the
///       family design with both. The P's of a base triangle also go to the View Test, which waits for them; in the
///       family design they reach the View Test with the edge.
/// Arithmetic: for a position 9 multiplications, a reciprocal (a table and 4 more) and 2 more, saturate (counted); for
///       a normal 9. Area reports count both, 24, since an item of the family design has both.
/// Timing: one vertex, normal or edge per interval and pipeline. Pipelines are used round-robin; items stay in order.
/// Waits only for its input; held back by Pass or Tessellate.
class Transform : public Stage<DisplacedPoint, ScreenPoint> {
  public:
    StreamInput<DisplacedPoint> from_displace_vertex{"from_displace_vertex"};
    StreamOutput<ScreenPoint> to_join;  ///< to Pass or Tessellate; in the family design to Tessellation
    sc_core::sc_vector<StreamOutput<ScreenCorner>> to_view_test;  ///< one per Tessellation Tests unit; families: none

    Transform(const sc_core::sc_module_name& name, const UnitContext& context);

    std::uint64_t positions() const { return positions_; }
    std::uint64_t normals() const { return normals_; }

  protected:
    ScreenPoint process(const DisplacedPoint& point, const Entries& entries) override;

    const datapath::Registers& registers_;
    std::uint64_t positions_ = 0;
    std::uint64_t normals_ = 0;
};

}  // namespace tessera
