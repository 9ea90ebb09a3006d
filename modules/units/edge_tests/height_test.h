#pragma once
#include <optional>
#include <systemc>

#include "modules/datapath/height_tests.h"
#include "modules/sockets/items.h"
#include "modules/sockets/memory_port.h"
#include "modules/stage/stage.h"

namespace tessera {

/// The unit of the Summed Height Test (paper figure 8), or of the test that a design has in its place. Its arithmetic,
/// table and latency: the test's file in modules/datapath.
///
/// In:   HeightOperands. Out: HeightResult; of a Rank Test with the rank, by which the `greatest_rank` cut chooses.
/// Memory: the test's table; for some edges the displacement map (HeightTestFunctions::reads_codes).
/// Timing: one edge per interval, or per table reads if they take longer; the test's latency follows the last entry.
/// Waits for Calculate New U (tests cheapest first: Sequence Tests) and the table, or the displacement map; held back by
/// the collector of the tests.
class HeightTestUnit : public Stage<HeightOperands, HeightResult> {
  public:
    StreamInput<HeightOperands> input{"input"};
    StreamOutput<HeightResult> output{"output"};
    MemoryPort table;
    std::optional<MemoryPort> displacement_map;  ///< if the test reads codes

    HeightTestUnit(const sc_core::sc_module_name& name, const UnitContext& context);
    /// With other functions than those of the design's test, whose table, timing and registers they share.
    HeightTestUnit(const sc_core::sc_module_name& name, const UnitContext& context,
                   const datapath::HeightTestFunctions& functions);

    void trace_signals(Signals& signals) const override;

  protected:
    void reads(const HeightOperands& edge, Reads& reads) const override;
    HeightResult process(const HeightOperands& edge, const Entries& entries) override;
    void trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult& result) const override;

    const datapath::Registers& registers_;

  private:
    const datapath::HeightTestFunctions& functions_;
    datapath::HeightDecision decision_;  // on the edge decided last
};

}  // namespace tessera
