#pragma once
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/timing.h"
#include "modules/units/tessellation_tests/calculate_new_u.h"
#include "modules/units/tessellation_tests/collect_tests.h"
#include "modules/units/tessellation_tests/normal_test.h"
#include "modules/units/tessellation_tests/summed_height_test.h"
#include "modules/units/tessellation_tests/tex_coord_test.h"
#include "modules/units/tessellation_tests/view_test.h"
#include "modules/wiring.h"

namespace tessera {

/// Tessellation Tests (paper figures 7 and 8): decides for each edge, from its two ends alone.
///
///     edge ──> Calculate New U ──┬──> Tex Coord Test ───────┐
///                                ├──> Summed Height Test ───┼──> Pass or Tessellate
///                                ├──> Normal Test ──────────┤
///              P's ──────────────┴──> View Test ────────────┘
///
/// In:   calculate_new_u.input: edges; vertices of a base triangle. view_test.from_transform: their screen positions.
/// Out:  collect_tests.to_pass_or_tessellate: edges[k] with the midpoint's t, N, T, N' and the tests' bits.
/// Of three units, each takes one edge of a triangle and, of a base triangle, the two vertices it joins (parts_for_tests).
/// Timing: edges go one after another through one pipeline; bound by the Summed Height Test's table reads. A design has
///       one such unit or three, one for each edge of a triangle, which share the memories.
/// Waits for Transform (base triangles), the Summed Height Table, the normal map; held back by Pass or Tessellate.
class TessellationTests : public sc_core::sc_module {
  public:
    CalculateNewU calculate_new_u;
    TexCoordTest tex_coord_test;
    SummedHeightTest summed_height_test;
    NormalTest normal_test;
    ViewTest view_test;
    CollectTests collect_tests;

    /// number: of the unit, of 1 or 3.
    TessellationTests(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                      const Timing& timing, unsigned number, unsigned units, bool use_direct_memory);

    /// Joins the units inside. To be called once.
    void wire(Wiring& wiring);
};

}  // namespace tessera
