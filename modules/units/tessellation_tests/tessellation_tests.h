#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/stream/stream.h"
#include "modules/timing.h"
#include "modules/units/tessellation_tests/calculate_new_u.h"
#include "modules/units/tessellation_tests/normal_test.h"
#include "modules/units/tessellation_tests/summed_height_test.h"
#include "modules/units/tessellation_tests/tex_coord_test.h"
#include "modules/units/tessellation_tests/view_test.h"

namespace tessera {

/// Tessellation Tests (paper figures 7 and 8): decides for each edge, from its two ends alone.
///
///     edge ──> Calculate New U ──┬──> Tex Coord Test ───────┐
///                                ├──> Summed Height Test ───┼──> Pass or Tessellate
///                                ├──> Normal Test ──────────┤
///              P's ──────────────┴──> View Test ────────────┘
///
/// In:   a pass with its triangle; for a base triangle the screen positions of its vertices, from Transform.
/// Out:  edges[0..2]: the midpoint's t, N, T, N' and the tests' bits.
/// Timing: the edges go one after another through one pipeline; bound by the Summed Height Test's table reads.
/// Waits for Transform (base triangles), the Summed Height Table, the normal map; held back by Pass or Tessellate.
class TessellationTests : public sc_core::sc_module {
  public:
    StreamTarget<TessellationTests, datapath::TrianglePass> from_get_triangle{"from_get_triangle"};
    StreamInitiator<TessellationTests, datapath::TrianglePass> to_pass_or_tessellate{"to_pass_or_tessellate"};

    CalculateNewU calculate_new_u;
    TexCoordTest tex_coord_test;
    SummedHeightTest summed_height_test;
    NormalTest normal_test;
    ViewTest view_test;

    TessellationTests(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                      const Timing& timing, bool use_direct_memory);

    std::uint64_t edges_tested() const { return edges_tested_; }

  private:
    void b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay);

    StreamInitiator<TessellationTests, datapath::TrianglePass> to_calculate_new_u_{"to_calculate_new_u"};
    StreamInitiator<TessellationTests, datapath::TrianglePass> to_tex_coord_test_{"to_tex_coord_test"};
    StreamInitiator<TessellationTests, datapath::TrianglePass> to_summed_height_test_{
        "to_summed_height_test"};
    StreamInitiator<TessellationTests, datapath::TrianglePass> to_normal_test_{"to_normal_test"};
    StreamInitiator<TessellationTests, datapath::TrianglePass> to_view_test_{"to_view_test"};
    std::uint64_t edges_tested_ = 0;
};

}  // namespace tessera
