#pragma once
#include <systemc>

#include "modules/sockets/items.h"
#include "modules/stage/stage.h"

namespace tessera {

/// Tex Coord Test (paper figure 8, 2.5, 3.1.2): has the map's resolution been reached? It includes the
/// Generation Test (golden/ALGORITHM.md 4.5): it also bounds the recursion and needs only the two ends, and figure 8
/// has no box for it.
///
/// In:   TexCoordOperands. Out: TexCoordResult.
/// Arithmetic: two compares of bit slices per axis; a maximum, an increment, a compare.
/// Timing: one edge per interval.
/// Waits for Calculate New U; held back by the collector of the tests.
class TexCoordTest : public Stage<TexCoordOperands, TexCoordResult> {
  public:
    StreamInput<TexCoordOperands> input{"input"};
    StreamOutput<TexCoordResult> output{"output"};

    TexCoordTest(const sc_core::sc_module_name& name, const UnitContext& context);

    void trace_signals(Signals& signals) const override;

  protected:
    TexCoordResult process(const TexCoordOperands& edge, const Entries& entries) override;
    void trace_processed(Signals& signals, const TexCoordOperands& edge, const TexCoordResult& result) const override;

    const datapath::Registers& registers_;
};

}  // namespace tessera
