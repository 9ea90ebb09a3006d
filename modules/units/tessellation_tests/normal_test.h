#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/memory/memory_port.h"
#include "modules/unit/per_triangle.h"
#include "modules/unit/stage.h"

namespace tessera {

/// Normal Test (paper figure 8, 2.2, 3.1.4): Calculate New N, Normalise, Bump, and the comparison of the displaced
/// normals. And, in the same place because it needs the same three normals and their differences, the optional Highlight
/// Test (golden/ALGORITHM.md 4.6), which asks for more where the Phong highlight is.
///
/// In:   edges, with N, T, N' of both ends and edges[k].texture; vertices of a base triangle, with N, T, t.
/// Out:  edges[k].normal = N_ij, .tangent = T_ij, .displaced_normal = N'_ij, normal_bit and highlight_bit of
///       edges[k].tests;
///       vertices[k].displaced_normal (a base triangle's corners are bumped first, and end here).
/// Memory: one read of the normal map per edge or vertex.
/// Arithmetic: add, shift by 1; the pipeline's existing normalise and bump units; six absolute differences and
///       compares, one OR. The Highlight Test adds three dot products with one vector, six compares with another
///       threshold and three with a cosine; the differences are the Normal Test's.
/// Timing: one edge or vertex per interval; latency 9 plus the map read, interval 1 by default. A Highlight Test adds its
///       own latency, 1 by default, and nothing to the interval.
///         An edge of a base triangle starts when the map entries of all corners that come to the unit have come.
/// State: one register: a base triangle's tag and which of its corners have been bumped.
/// Waits for Calculate New U and the normal map. Held back by the collection of the tests.
class NormalTest final : public Stage<Work> {
  public:
    StreamInput<Work> input{"input"};
    StreamOutput<Work> output{"output"};
    MemoryPort normal_map;

    /// takes: the vertices and edges of a triangle that come to the unit (parts_for_tests).
    NormalTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
               const Timing& timing, bool use_direct_memory, Parts takes = parts_for_tests(0, 1));

    const datapath::Saturations& saturations() const { return saturations_; }

    void show(Signals& signals) const override;

  private:
    bool may_start(const Work& part) const override;
    void reads(const Work& part, Reads& reads) const override;
    Work process(const Work& part, const Entries& entries) override;
    void trace_started(Signals& signals, const Work& part) const override;
    void trace_processed(Signals& signals, const Work& part, const Work& result) const override;

    datapath::Direction bumped(const datapath::Direction& n, const datapath::Direction& t, int handedness,
                               std::uint64_t entry);
    void test_edge(const Work& edge, std::uint64_t entry);

    const datapath::Registers& registers_;
    Parts takes_;
    PerTriangle<Parts> corners_bumped_{1};  // of base triangles
    datapath::Saturations saturations_;
};

}  // namespace tessera
