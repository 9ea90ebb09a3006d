#pragma once
#include <systemc>

#include "modules/datapath/parameters.h"
#include "modules/unit/stage.h"

namespace tessera {

/// Tex Coord Test (paper figure 8, 2.5, 3.1.2): has the map's resolution been reached? And, in the same place because
/// both bound the recursion, the generation test (golden/ALGORITHM.md 4.5).
///
/// In:   t and generation of both ends; edges[k].texture. Out: tex_coord_bit and generation_bit of edges[k].tests.
/// Arithmetic: two compares of bit slices per axis; a maximum, an increment, a compare.
/// Timing: one edge per interval; latency 1, interval 1 by default.
/// Waits for Calculate New U; held back by the collection of the tests.
class TexCoordTest final : public Stage<Work> {
  public:
    StreamInput<Work> input{"input"};
    StreamOutput<Work> output{"output"};

    TexCoordTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                 const Timing& timing);

    void show(Signals& signals) const override;

  private:
    Work process(const Work& part, const Entries& entries) override;
    void trace_processed(Signals& signals, const Work& part, const Work& result) const override;

    const datapath::Registers& registers_;
};

}  // namespace tessera
