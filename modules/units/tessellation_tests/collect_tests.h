#pragma once
#include <array>
#include <cstdint>
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/stream/stream_input.h"
#include "modules/stream/stream_output.h"
#include "modules/stream/work.h"
#include "modules/timing.h"
#include "modules/unit/per_triangle.h"
#include "modules/unit/unit.h"

namespace tessera {

/// Where the lines from the four tests meet on their way to Pass or Tessellate (paper figure 8): an edge goes on when
/// all four have decided.
///
/// In:   edges, from each test. Out: the edge, once.
/// Timing: one edge a cycle, no latency of its own: wires. Capacity: per test `results_buffer` edges that wait for
///       the other tests.
/// Waits for the slowest test; held back by Pass or Tessellate.
class CollectTests : public Unit {
  public:
    StreamInput<Work> from_normal_test{"from_normal_test"};
    StreamInput<Work> from_tex_coord_test{"from_tex_coord_test"};
    StreamInput<Work> from_summed_height_test{"from_summed_height_test"};
    StreamInput<Work> from_view_test{"from_view_test"};
    StreamOutput<Work> to_pass_or_tessellate{"to_pass_or_tessellate"};

    CollectTests(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                 const Timing& timing);

    std::string holds() const override;
    std::uint64_t occupied_cycles() const override { return activity_.items_in(); }
    void show(Signals& signals) const override;
    Begun begun() const override { return Begun::of(activity_.items_in(), leaving_); }

  private:
    /// How many tests have decided the edges of a triangle, and when the last of them had.
    struct Decided {
        unsigned tests = 0;
        sc_core::sc_time latest;
    };

    void b_transport(Work& work, sc_core::sc_time& delay);
    void step() override;
    std::array<StreamInput<Work>*, 4> inputs() {
        return {&from_normal_test, &from_tex_coord_test, &from_summed_height_test, &from_view_test};
    }

    const datapath::Registers& registers_;
    Work leaving_;
    bool leaves_ = false;
    unsigned empty_inputs_ = 0;
    PerTriangle<Decided> decided_{1};  // functional mode
};

}  // namespace tessera
