#pragma once
#include <array>
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/sockets/memory_port.h"
#include "modules/stage/per_triangle.h"
#include "modules/stage/stage.h"

namespace tessera {

/// Normal Test (paper figure 8, 2.2, 3.1.4): Calculate New N, Normalise, Bump, and the comparison of the displaced
/// normals. It includes the optional Highlight Test (golden/ALGORITHM.md 4.6), which uses the same three normals and
/// their differences, and splits further where the Phong highlight is.
///
/// In:   NormalOperands: edges; for a base triangle its vertices first, which are bumped and go no further.
///       In the family design N' of all vertices is known, and only edges arrive.
/// Out:  NormalResult: N_ij, T_ij, N'_ij, the tests' bits, and N' of the edge's first end: a base triangle's three
///       edges deliver its corners' N' without a stream for vertices to Pass or Tessellate, for 3 x 16 wires.
/// Memory: one read of the normal map per edge or vertex; with a bilinear filter (Formats::filter) one request of four
///       entries.
/// Arithmetic: add, shift by 1; the pipeline's existing normalise and bump units; six absolute differences and
///       compares, one OR. A bilinear filter adds nine multiplications. The Highlight Test adds three dot products with
///       one vector, six compares with a second threshold and three with a cosine, at full width, so that the ends'
///       products equal the golden model's bit for bit; the differences are shared. (Decision: nine multipliers keep
///       the interval at 1. Three would do if each vertex carried its result, as one more bit.)
/// Timing: one edge or vertex per interval, or per map read if that takes longer. The latency follows the read; a
///       Highlight Test adds its own, and nothing to the interval. An edge of a base triangle starts when the map
///       entries of all its corners in this unit have arrived.
/// State: a base triangle's tag, and N' of its corners.
/// Waits for Calculate New U (tests cheapest first: Sequence Tests) and the normal map. Held back by the collector of
/// the tests.
class NormalTest : public Stage<NormalOperands, NormalResult> {
  public:
    StreamInput<NormalOperands> input{"input"};
    StreamOutput<NormalResult> output{"output"};
    MemoryPort normal_map;

    NormalTest(const sc_core::sc_module_name& name, const UnitContext& context);

    void trace_signals(Signals& signals) const override;

  protected:
    /// The corners of a base triangle.
    struct Corners {
        Parts bumped = 0;
        std::uint64_t known_from = 0;  // the cycle in which the map entry of the last one arrives
        Parts tested = 0;              // edges
        std::array<datapath::Direction, 3> displaced_n;
    };

    bool may_start(const NormalOperands& part) const override;
    void reads(const NormalOperands& part, Reads& reads) const override;
    NormalResult process(const NormalOperands& part, const Entries& entries) override;
    void trace_processed(Signals& signals, const NormalOperands& part, const NormalResult& result) const override;

    datapath::Direction bumped(const datapath::Direction& n, const datapath::Direction& t, int handedness,
                               const datapath::Direction& map_normal);
    NormalResult test_edge(const NormalOperands& edge, const datapath::Direction& map_normal);
    void take_corners(const NormalOperands& edge);

    const datapath::Registers& registers_;
    Parts takes_;  // the vertices and edges of a triangle that this unit receives
    PerTriangle<Corners> corners_{1};
    std::array<datapath::Direction, 3> compared_{};  // N'_i, N'_j, N'_ij of the part worked on last
};

}  // namespace tessera
