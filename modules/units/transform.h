#pragma once
#include <cstdint>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/stage/stage.h"

namespace tessera {

/// Transform (paper figure 7): world to screen; the pipeline's existing unit, OpenGL's clipping, perspective and
/// viewport application.
///
/// In:   DisplacedPoint. Out: ScreenPoint: of an edge or vertex with P's, of a normal with N's in N's place; of families
///       with both. A base triangle's P's also go to the View Test, which waits for them; of families the View Test has
///       them with the edge.
/// Arithmetic: a position: 9 multiplications, a reciprocal (a table and 4 more) and 2 more, saturate (counted); a normal:
///       9. The reports of area count both, 24: a machine of families has both in one item.
/// Timing: one vertex, normal or edge per interval and pipeline; latency 20, interval 1, one pipeline by default.
///       Several pipelines take turns; items stay in order.
/// Waits for nothing but its input; held back by Pass or Tessellate.
class Transform : public Stage<DisplacedPoint, ScreenPoint> {
  public:
    StreamInput<DisplacedPoint> from_displace_vertex{"from_displace_vertex"};
    StreamOutput<ScreenPoint> to_join;  ///< to Pass or Tessellate; of families, to Tessellation
    sc_core::sc_vector<StreamOutput<ScreenCorner>> to_view_test;  ///< one per Tessellation Tests unit; of families none

    Transform(const sc_core::sc_module_name& name, const UnitContext& context);

    const datapath::Saturations& saturations() const { return saturations_; }
    std::uint64_t positions() const { return positions_; }
    std::uint64_t normals() const { return normals_; }

  protected:
    ScreenPoint process(const DisplacedPoint& point, const Entries& entries) override;

    const datapath::Registers& registers_;
    datapath::Saturations saturations_;
    std::uint64_t positions_ = 0;
    std::uint64_t normals_ = 0;
};

}  // namespace tessera
