#pragma once
#include <memory>
#include <systemc>
#include <vector>

#include "modules/timing/design.h"
#include "modules/unit_factory.h"
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
    struct Units {
        std::unique_ptr<CalculateNewU> calculate_new_u;
        std::unique_ptr<TexCoordTest> tex_coord_test;
        std::unique_ptr<HeightTestUnit> height_test;
        std::unique_ptr<NormalTest> normal_test;
        std::unique_ptr<ViewTest> view_test;
        // One of these; the others are null.
        std::unique_ptr<CollectTests> collect_tests;
        std::unique_ptr<SequenceTests> sequence_tests;
        std::unique_ptr<FamilySequenceTests> family_sequence_tests;
        // Only in the family design.
        std::vector<std::unique_ptr<CalculateNewU>> further_calculate_new_u;
        std::vector<std::unique_ptr<TexCoordTest>> further_tex_coord_tests;
        std::vector<std::unique_ptr<ViewTest>> further_view_tests;
        std::vector<std::unique_ptr<NormalTest>> further_normal_tests;
    };
    const Units made_;

  public:
    CalculateNewU& calculate_new_u = *made_.calculate_new_u;
    TexCoordTest& tex_coord_test = *made_.tex_coord_test;
    HeightTestUnit& height_test = *made_.height_test;  ///< the Summed Height Test, or the test in its place
    NormalTest& normal_test = *made_.normal_test;
    ViewTest& view_test = *made_.view_test;
    CollectTests* const collect_tests = made_.collect_tests.get();     ///< null: cheapest first
    SequenceTests* const sequence_tests = made_.sequence_tests.get();  ///< null: in parallel, or of families
    FamilySequenceTests* const family_sequence_tests = made_.family_sequence_tests.get();

    /// A lane of cheap tests; the triangle design has one.
    struct Lane {
        CalculateNewU& calculate_new_u;
        TexCoordTest& tex_coord_test;
        ViewTest& view_test;
    };
    const std::vector<Lane>& lanes() const { return lanes_; }
    const std::vector<NormalTest*>& normal_tests() const { return normal_tests_; }

    TessellationTests(const sc_core::sc_module_name& name, const UnitContext& context, UnitFactory& factory);

    /// Binds the units inside to one another. Call once.
    void wire();

    /// The unit that joins an edge's results.
    Unit& collector() const;
    StreamOutput<TestedEdge>& to_pass_or_tessellate(std::size_t lane = 0) const;

    /// In the order of figure 8, further lanes and Normal Tests last.
    std::vector<Unit*> units() const;

  private:
    void wire_lanes();
    template <class Collector>
    void take_results(Collector& collector);
    static Units make(const UnitContext& context, UnitFactory& factory);

    std::vector<Lane> lanes_;
    std::vector<NormalTest*> normal_tests_;
};

}  // namespace tessera
