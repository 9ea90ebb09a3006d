#pragma once
#include <systemc>

#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"
#include "modules/timing.h"
#include "modules/unit/work_stage.h"

namespace tessera {

/// Calculate New U (paper figure 8, 3.1.2): the texture coordinate of the edge's midpoint, which all tests start from.
///
/// In:   edges, with t_i, t_j; vertices of a base triangle, on their way to the Normal Test, pass unchanged.
/// Out:  edges[k].texture = (t_i + t_j) >> 1, to all four tests.
/// Arithmetic: add, shift by 1.
/// Timing: one edge or vertex per interval; latency 1, interval 1 by default.
/// Waits for nothing but its input; held back by the slowest of the tests.
class CalculateNewU : public WorkStage<CalculateNewU> {
  public:
    StreamInput<Work> input{"input"};
    StreamOutput<Work> to_tex_coord_test{"to_tex_coord_test"};
    StreamOutput<Work> to_summed_height_test{"to_summed_height_test"};
    StreamOutput<Work> to_normal_test{"to_normal_test"};
    StreamOutput<Work> to_view_test{"to_view_test"};

    CalculateNewU(const sc_core::sc_module_name& name, Clock& clock, const Timing& timing);

  private:
    friend class WorkStage<CalculateNewU>;
    void b_transport(Work& work, sc_core::sc_time& delay);
    void process(const Work& work);
    unsigned targets(const Work& work) const;
    void trace_item(Signals& signals, const Work& work) const;
};

}  // namespace tessera
