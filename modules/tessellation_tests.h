#pragma once
#include <systemc>
#include <vector>

#include "modules/netlist.h"
#include "modules/units/edge_tests/calculate_new_u.h"
#include "modules/units/edge_tests/collecting_unit.h"
#include "modules/units/edge_tests/height_test.h"
#include "modules/units/edge_tests/normal.h"
#include "modules/units/edge_tests/tex_coord.h"
#include "modules/units/edge_tests/view.h"

namespace tessera {

/// Tessellation Tests (paper figures 7 and 8): decides for each edge, from its two ends alone.
///
///     edge ──> Calculate New U ──┬──> Tex Coord Test ───────┐
///                                ├──> Summed Height Test ───┼──> Collect Tests ──> Pass or Tessellate
///                                ├──> Normal Test ──────────┤
///              P's ──────────────┴──> View Test ────────────┘
///
/// All tests of all edges are evaluated, in parallel, so that reads and widths are those of the paper's hardware. With
/// the tests evaluated cheapest first (Design::test_order):
///
///     edge ──> Calculate New U ──┬──> Tex Coord Test ──┐
///              P's ──────────────┼──> View Test ───────┤
///                                └─────────────────────┴──> Sequence Tests ──> Pass or Tessellate
///                                                             ↕         ↕
///                                                   Normal Test     Summed Height Test
///
/// In the family design there may be several lanes of Calculate New U, Tex Coord Test and View Test before Sequence
/// Tests, and several Normal Tests after it; edges arrive from Tessellation, with P's.
///
/// In:   calculate_new_u.input: edges; vertices of a base triangle. view_test.from_transform: their screen positions.
/// Out:  collector.tested_edges(): TestedEdge.
/// With three units each receives one edge of a triangle and, for a base triangle, the two vertices of the edge
/// (parts_for_tests): they share nothing but the memories. Each corner is then bumped twice, for three more reads of
/// the normal map and one more cycle per base triangle.
/// Timing: edges go one after another through one pipeline; bound by the Summed Height Test's table reads. A design has
///       one such unit or three, one for each edge of a triangle, which share the memories.
/// Waits for Transform (base triangles), the Summed Height Table, the normal map; held back by Pass or Tessellate.
class TessellationTests : public sc_core::sc_module {
    Netlist netlist_;

  public:
    // The first of each lane and of each kind.
    CalculateNewU& calculate_new_u = netlist_.the<CalculateNewU>();
    TexCoordTest& tex_coord_test = netlist_.the<TexCoordTest>();
    HeightTestUnit& height_test = netlist_.the<HeightTestUnit>();  ///< the Summed Height Test, or that in its place
    NormalTest& normal_test = netlist_.the<NormalTest>();
    ViewTest& view_test = netlist_.the<ViewTest>();
    CollectingUnit& collector = netlist_.the<CollectingUnit>();

    TessellationTests(const sc_core::sc_module_name& name, const UnitContext& context, UnitFactory& factory)
        : sc_module(name), netlist_(units_of(context, factory)) {}

    /// Its units in the order of figure 8, further lanes and Normal Tests last.
    const Netlist& netlist() const { return netlist_; }
    std::vector<NormalTest*> normal_tests() const { return netlist_.all<NormalTest>(); }

  private:
    static Netlist units_of(const UnitContext& context, UnitFactory& factory);
};

}  // namespace tessera
