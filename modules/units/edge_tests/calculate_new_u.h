#pragma once
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/stage/stage.h"

namespace tessera {

/// An edge, or a vertex of a base triangle, with the texture coordinate at which it is tested.
struct EdgeToTest : TestOperands {
    static constexpr const char* name = "edge to test";
    datapath::TexCoord t_ij;  ///< for a vertex, its own t

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.texture("t_ij", item.t_ij, "t of the midpoint");
    }
};

/// Calculate New U (paper figure 8, 3.1.2): the texture coordinate of the edge's midpoint, for all tests.
///
/// In:   TestOperands: edges, with t_i, t_j; vertices of a base triangle, which go unchanged to the Normal Test only.
/// Out:  t_ij = (t_i + t_j) >> 1, to all four tests, with the operands of the edge's ends that each test needs.
/// Arithmetic: add, shift by 1.
/// Timing: one edge or vertex per interval.
/// Waits only for its input; held back by the slowest of the tests.
class CalculateNewU : public Stage<TestOperands, EdgeToTest> {
  public:
    StreamInput<TestOperands> input{"input"};
    StreamOutput<TexCoordOperands> to_tex_coord_test{"to_tex_coord_test"};
    StreamOutput<HeightOperands> to_summed_height_test{"to_summed_height_test"};
    StreamOutput<NormalOperands> to_normal_test{"to_normal_test"};
    StreamOutput<ViewOperands> to_view_test{"to_view_test"};

    CalculateNewU(const sc_core::sc_module_name& name, const UnitContext& context);

  protected:
    EdgeToTest process(const TestOperands& part, const Entries& entries) override;
};

}  // namespace tessera
