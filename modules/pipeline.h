#pragma once
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/clock/clock.h"
#include "modules/memory/off_chip_memory.h"
#include "modules/memory/table_memory.h"
#include "modules/unit/pass_pool.h"
#include "modules/units/calculate_new_p.h"
#include "modules/units/displace_vertex.h"
#include "modules/units/get_triangle.h"
#include "modules/units/lighting.h"
#include "modules/units/pass_or_tessellate.h"
#include "modules/units/tessellation.h"
#include "modules/units/tessellation_tests/tessellation_tests.h"
#include "modules/units/transform.h"
#include "modules/units/triangle_queue.h"
#include "modules/wiring.h"

namespace tessera {

/// How the units talk to one another.
enum class Transport {
    blocking,      ///< blocking transport: every result, no cycles (functional mode)
    non_blocking,  ///< non-blocking transport: the same results, to the cycle (timed mode)
};

/// What is built, as opposed to what is set before a run (datapath::Registers).
struct Design {
    Transport transport = Transport::blocking;
    Timing timing;
    QueueDesign queue;
    unsigned tests_units = 1;  ///< Tessellation Tests units: 1 or 3
    unsigned transform_pipelines = 1;
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
    Clock clock;
    PassPool passes;
    GetTriangle get_triangle;
    CalculateNewP calculate_new_p;
    DisplaceVertex displace_vertex;
    Transform transform;
    sc_core::sc_vector<TessellationTests> tessellation_tests;
    PassOrTessellate pass_or_tessellate;
    Tessellation tessellation;
    TriangleQueue triangle_queue;
    Lighting lighting;
    DisplacementMap displacement_map;
    NormalMap normal_map;
    SummedHeightTable summed_height_table;
    OffChipMemory off_chip_memory;

    /// `registers` must outlive the pipeline. wiring: null: outputs straight to inputs.
    Pipeline(const sc_core::sc_module_name& name, const datapath::Registers& registers, const Design& design,
             Wiring* wiring = nullptr);

    /// Nothing is in flight.
    bool idle() const;

    /// Every unit and memory, in the order of the figures.
    const std::vector<Unit*>& units() const { return units_; }

    /// Items are held back at random.
    bool random_stalls() const { return random_stalls_; }

    std::uint64_t edges_tested() const { return 3 * pass_or_tessellate.counts().passes; }
    std::uint64_t displacement_map_reads() const { return displace_vertex.displacement_map.reads(); }
    std::uint64_t normal_map_reads() const;
    std::uint64_t summed_height_table_reads() const;
    datapath::Saturations saturations() const;

  private:
    void wire(Wiring& wiring);
    void attach();

    Transport transport_;
    bool random_stalls_;
    std::vector<Unit*> units_;
};

}  // namespace tessera
