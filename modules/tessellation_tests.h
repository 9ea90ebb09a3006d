#pragma once
#include <systemc>
#include <vector>

#include "modules/made_units.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/units/edge_tests/calculate_new_u.h"
#include "modules/units/edge_tests/collect_tests.h"
#include "modules/units/edge_tests/height_test.h"
#include "modules/units/edge_tests/normal.h"
#include "modules/units/edge_tests/sequence_tests.h"
#include "modules/units/edge_tests/tex_coord.h"
#include "modules/units/edge_tests/view.h"
#include "modules/units/families/sequence_tests.h"

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
/// Out:  to_pass_or_tessellate(): TestedEdge.
/// With three units each receives one edge of a triangle and, for a base triangle, the two vertices of the edge
/// (parts_for_tests): they share nothing but the memories. Each corner is then bumped twice, for three more reads of
/// the normal map and one more cycle per base triangle.
/// Timing: edges go one after another through one pipeline; bound by the Summed Height Test's table reads. A design has
///       one such unit or three, one for each edge of a triangle, which share the memories.
/// Waits for Transform (base triangles), the Summed Height Table, the normal map; held back by Pass or Tessellate.
class TessellationTests : public sc_core::sc_module {
    MadeUnits made_;

  public:
    CalculateNewU& calculate_new_u = made_.make<CalculateNewU>("calculate_new_u");
    TexCoordTest& tex_coord_test = made_.make<TexCoordTest>("tex_coord_test");
    /// The Summed Height Test, or the test in its place.
    HeightTestUnit& height_test =
        made_.make<HeightTestUnit>(functions_of(made_.context().registers.formats.height_test).unit());
    NormalTest& normal_test = made_.make<NormalTest>("normal_test");
    ViewTest& view_test = made_.make<ViewTest>("view_test");
    // One of these joins an edge's results; the others are null.
    CollectTests* const collect_tests =
        made_.context().design.test_order == TestOrder::parallel ? &made_.make<CollectTests>("collect_tests") : nullptr;
    SequenceTests* const sequence_tests =
        collect_tests == nullptr ? made_.make_for<SequenceTests>(Work::triangle, "sequence_tests") : nullptr;
    FamilySequenceTests* const family_sequence_tests =
        collect_tests == nullptr ? made_.make_for<FamilySequenceTests>(Work::family, "sequence_tests") : nullptr;
    Unit& collector = the_one<Unit>({collect_tests, sequence_tests, family_sequence_tests});

    /// A lane of cheap tests; the triangle design has one.
    struct Lane {
        CalculateNewU& calculate_new_u;
        TexCoordTest& tex_coord_test;
        ViewTest& view_test;
    };
    const std::vector<Lane>& lanes() const { return lanes_; }
    const std::vector<NormalTest*>& normal_tests() const { return normal_tests_; }

    /// units: the machine's, to which these are added in the order of figure 8, further lanes and Normal Tests last.
    TessellationTests(const sc_core::sc_module_name& name, const UnitContext& context, UnitFactory& factory,
                      std::vector<Unit*>& units);

    StreamOutput<TestedEdge>& to_pass_or_tessellate(std::size_t lane = 0) const;

    /// Binds the units inside to one another. Call once.
    void wire();
    /// Downstream first.
    void attach(CycleScheduler& clock);

  private:
    void wire_lanes();
    template <class Collector>
    void take_results(Collector& its);

    std::vector<Lane> lanes_{{calculate_new_u, tex_coord_test, view_test}};
    std::vector<NormalTest*> normal_tests_{&normal_test};
};

}  // namespace tessera
