#include "modules/units/edge_tests/tex_coord.h"

#include "modules/datapath/edge_tests.h"
#include "modules/stage/stage_steps.h"

namespace tessera {

TexCoordTest::TexCoordTest(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, context.timing().tex_coord_test), registers_(context.registers) {
    takes_from(context, input);
    delivers_to(context, output);
}

TexCoordResult TexCoordTest::process(const TexCoordOperands& edge, const Entries&) {
    const datapath::TestParameters& tests = registers_.tests;
    return {edge.tag, edge.t_ij,
            !tests.tex_coord_test || tex_coord_test(edge.t_i, edge.t_j, edge.t_ij, registers_.formats),
            !tests.generation_test || datapath::generation_test(edge.generation_i, edge.generation_j, tests)};
}

void TexCoordTest::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    signals.value("generation_limit", 32, registers_.tests.generation_limit);
}

void TexCoordTest::trace_processed(Signals& signals, const TexCoordOperands& edge, const TexCoordResult&) const {
    signals.value("generation_ij", 8, datapath::inserted_generation(edge.generation_i, edge.generation_j));
}

}  // namespace tessera
