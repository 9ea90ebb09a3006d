#include "modules/units/edge_tests/curvature.h"

#include "modules/stage/stage_steps.h"

namespace tessera {

CurvatureTest::CurvatureTest(const sc_core::sc_module_name& name, const UnitContext& context)
    : HeightTestUnit(name, context) {
    multiplies(curvature_measure_multiplications(registers_.formats));
}

void CurvatureTest::reads(const HeightOperands& edge, Reads& reads) const {
    if (!registers_.tests.summed_height_test)
        return;
    reads.through(curvature_by_codes(edge.t_i, edge.t_j, registers_.formats) ? 1 : 0);
    reads.add_request();
    curvature_reads(edge.t_i, edge.t_j, edge.t_ij, registers_,
                    [&](std::uint64_t address) { reads.add_entry(address); });
}

HeightResult CurvatureTest::process(const HeightOperands& edge, const Entries& entries) {
    measure_ =
        registers_.tests.summed_height_test ? curvature_of_entries(edge.t_i, edge.t_j, entries, registers_.formats) : 0;
    return {edge.tag, registers_.tests.summed_height_test && curvature_test(measure_, registers_.tests), 0};
}

void CurvatureTest::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    signals.value("threshold", 40, registers_.tests.curvature_threshold);
}

void CurvatureTest::trace_processed(Signals& signals, const HeightOperands& edge, const HeightResult&) const {
    signals.value("level", 4, static_cast<unsigned>(curvature_level(edge.t_i, edge.t_j, registers_.formats)));
    signals.value("measure", 40, measure_);
}

}  // namespace tessera
