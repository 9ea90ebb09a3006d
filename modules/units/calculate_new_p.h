#pragma once
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/stage/stage.h"

namespace tessera {

/// Calculate New P (paper figure 7): the midpoint of the two ends of each edge.
///
/// In:   GeometryOperands.
/// Out:  BasePoint: for an edge (P_i + P_j) >> 1, likewise t and N, the latter not yet of unit length; vertices and
///       normals unchanged. In the family design N_ij and N'_ij arrive with the edge. (Decision: t_ij and the mean
///       normal are calculated both here and in Tessellation Tests, since a stream between the two branches would
///       serialise them. It costs five adders and a second use of the normalise unit, in Displace Vertex. Pass or
///       Tessellate checks that both t_ij agree.)
/// Arithmetic: add, arithmetic shift right by 1.
/// Timing: one vertex, normal or edge per interval.
/// Waits only for its input; held back by Displace Vertex.
class CalculateNewP : public Stage<GeometryOperands, BasePoint> {
  public:
    StreamInput<GeometryOperands> from_get_triangle{"from_get_triangle"};
    StreamOutput<BasePoint> to_displace_vertex{"to_displace_vertex"};

    CalculateNewP(const sc_core::sc_module_name& name, const UnitContext& context);

  protected:
    BasePoint process(const GeometryOperands& part, const Entries& entries) override;

    const datapath::Registers& registers_;
};

}  // namespace tessera
