#pragma once
#include <optional>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/memory_port.h"
#include "modules/stage/stage.h"

namespace tessera {

/// Displace Vertex (paper figure 7): P' = P + (S * d(t) + bias) * N, the one added long-latency unit.
///
/// In:   BasePoint. Out: DisplacedPoint: the same and, for an edge or vertex, P'; normals unchanged. In the family
///       design also N' of a base triangle's vertex.
/// Memory: one read of the displacement map per vertex or edge; in the family design one read of the normal map per
///       vertex. With a bilinear filter (Formats::filter) each read is one request of four entries.
/// Arithmetic: normalise an edge's normal (the pipeline's existing unit; in the family design it arrives normalised),
///       multiply, round, multiply-accumulate, saturate (counted). In the family design bump a vertex's normal. A
///       bilinear filter first interpolates: three multiplications per code, nine per normal.
///       (Decision: a bump unit of its own, 27 multipliers, since the Normal Test is the bottleneck and its N' would be
///       too late for Transform: each base vertex would pass here twice. So a base triangle is complete when it leaves
///       Transform. On the job `head`, with 0.26 such vertices per finished triangle, this saves 0.20 cycles per
///       finished triangle, with two Normal Tests 0.07.)
/// Timing: one vertex, normal or edge per interval, or per map read if that takes longer: four cycles per edge with a
///       bilinear filter and one port. The latency follows the read.
/// Waits for the displacement map and the normal map; held back by Transform.
class DisplaceVertex : public Stage<BasePoint, DisplacedPoint> {
  public:
    StreamInput<BasePoint> from_calculate_new_p{"from_calculate_new_p"};
    StreamOutput<DisplacedPoint> to_transform{"to_transform"};
    MemoryPort displacement_map;
    std::optional<MemoryPort> normal_map;  ///< only in the family design

    DisplaceVertex(const sc_core::sc_module_name& name, const UnitContext& context);

  protected:
    void reads(const BasePoint& point, Reads& reads) const override;
    DisplacedPoint process(const BasePoint& point, const Entries& entries) override;

    const datapath::Registers& registers_;
};

}  // namespace tessera
