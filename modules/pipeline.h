#pragma once
#include <systemc>

#include "modules/memory/table_memory.h"
#include "modules/units/calculate_new_p.h"
#include "modules/units/displace_vertex.h"
#include "modules/units/get_triangle.h"
#include "modules/units/lighting.h"
#include "modules/units/pass_or_tessellate.h"
#include "modules/units/tessellation.h"
#include "modules/units/tessellation_tests/tessellation_tests.h"
#include "modules/units/transform.h"
#include "modules/units/triangle_queue.h"

namespace tessera {

/// What is built, as opposed to what is set before a run (datapath::Registers).
struct Design {
    Timing timing;
    TriangleOrder queue_order = TriangleOrder::fifo;
    std::size_t queue_watermark = 1;
    bool direct_memory = true;  ///< units read memories through DMI in functional mode
};

/// The machine of the paper's figure 7: every unit, every memory, and the wires between them.
///
///     host ──> Get Triangle ──> Calculate New P ──> Displace Vertex ──> Transform ─────────┐
///                ^    │                             (displacement map)                     v
///                │    └───────────────> Tessellation Tests ─────────────────────> Pass or Tessellate ──> Lighting
///                │                      (Summed Height Table, normal map)                  │                 │
///                └── Triangle Queue <── Tessellation <─────────────────────────────────────┘                 v
///                                                                                                       rasteriser
///
/// Outside: get_triangle.from_host, lighting.to_rasteriser, and the memories' sockets for the host's preload.
class Pipeline : public sc_core::sc_module {
  public:
    GetTriangle get_triangle;
    CalculateNewP calculate_new_p;
    DisplaceVertex displace_vertex;
    Transform transform;
    TessellationTests tessellation_tests;
    PassOrTessellate pass_or_tessellate;
    Tessellation tessellation;
    TriangleQueue triangle_queue;
    Lighting lighting;
    DisplacementMap displacement_map;
    NormalMap normal_map;
    SummedHeightTable summed_height_table;

    /// `registers` must outlive the pipeline.
    Pipeline(const sc_core::sc_module_name& name, const datapath::Registers& registers, const Design& design);

    /// Nothing is in flight.
    bool idle() const { return triangle_queue.idle() && pass_or_tessellate.idle(); }

    datapath::Saturations saturations() const;
};

}  // namespace tessera
