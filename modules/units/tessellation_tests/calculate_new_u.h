#pragma once
#include <systemc>

#include "modules/unit/stage.h"

namespace tessera {

/// Calculate New U (paper figure 8, 3.1.2): the texture coordinate of the edge's midpoint, which all tests start from.
///
/// In:   edges, with t_i, t_j; vertices of a base triangle, which pass unchanged, to the Normal Test alone.
/// Out:  edges[k].texture = (t_i + t_j) >> 1, to all four tests.
/// Arithmetic: add, shift by 1.
/// Timing: one edge or vertex per interval; latency 1, interval 1 by default.
/// Waits for nothing but its input; held back by the slowest of the tests.
class CalculateNewU final : public Stage<Work> {
  public:
    StreamInput<Work> input{"input"};
    StreamOutput<Work> to_tex_coord_test{"to_tex_coord_test"};
    StreamOutput<Work> to_summed_height_test{"to_summed_height_test"};
    StreamOutput<Work> to_normal_test{"to_normal_test"};
    StreamOutput<Work> to_view_test{"to_view_test"};

    CalculateNewU(const sc_core::sc_module_name& name, Clock& clock, const Timing& timing);

  private:
    Work process(const Work& part, const Entries& entries) override;
    void trace_processed(Signals& signals, const Work& part, const Work& result) const override;
};

}  // namespace tessera
