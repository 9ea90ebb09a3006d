#include "modules/units/tessellation_tests/tex_coord_test.h"

#include "modules/datapath/edge_tests.h"
#include "modules/unit/signals.h"

namespace tessera {

TexCoordTest::TexCoordTest(const sc_core::sc_module_name& name, Clock& clock,
                           const datapath::Registers& registers, const Timing& timing)
    : Stage(name, clock, timing.tex_coord_test), registers_(registers) {
    takes_from(input, timing.stalls);
    delivers_to(output);
}

Work TexCoordTest::process(const Work& part, const Entries&) {
    const datapath::TestParameters& tests = registers_.tests;
    const int k = static_cast<int>(part.index());
    const datapath::Vertex& i = part.pass->edge_begin(k);
    const datapath::Vertex& j = part.pass->edge_end(k);
    datapath::EdgeTests& edge = part.pass->edges[part.index()];
    if (!tests.tex_coord_test || tex_coord_test(i.texture, j.texture, edge.texture, registers_.formats))
        edge.tests |= datapath::tex_coord_bit;
    if (!tests.generation_test || generation_test(i, j, tests))
        edge.tests |= datapath::generation_bit;
    return part;
}

void TexCoordTest::show(Signals& signals) const {
    Stage::show(signals);
    signals.value("generation_limit", 32, registers_.tests.generation_limit);
}

void TexCoordTest::trace_processed(Signals& signals, const Work& work, const Work&) const {
    const unsigned tests = Signals::pass_of(work).edges[work.index()].tests;
    signals.edge_textures(work);
    signals.value("generation_i", 8, Signals::begin_of(work).generation);
    signals.value("generation_j", 8, Signals::end_of(work).generation);
    signals.value("generation_ij", 8, inserted_generation(Signals::begin_of(work), Signals::end_of(work)));
    signals.flag("tex_coord", (tests & datapath::tex_coord_bit) != 0);
    signals.flag("generation", (tests & datapath::generation_bit) != 0);
}

}  // namespace tessera
