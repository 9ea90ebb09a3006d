#include "modules/units/tessellation_tests/tex_coord_test.h"

#include "modules/datapath/edge_tests.h"
#include "modules/unit/signals.h"

namespace tessera {

TexCoordTest::TexCoordTest(const sc_core::sc_module_name& name, Clock& clock,
                           const datapath::Registers& registers, const Timing& timing)
    : WorkStage(name, clock, timing.tex_coord_test), registers_(registers) {
    takes_from(input, timing.stalls);
    delivers_to(output);
    input.serve<&TexCoordTest::b_transport>(*this);
}

void TexCoordTest::process(const Work& work) {
    const datapath::TestParameters& tests = registers_.tests;
    Pass& pass = *work.pass;
    for_each_of_three(work.parts, first_edge_part, [&](unsigned k) {
        const datapath::Vertex& i = pass.edge_begin(static_cast<int>(k));
        const datapath::Vertex& j = pass.edge_end(static_cast<int>(k));
        datapath::EdgeTests& edge = pass.edges[k];
        if (!tests.tex_coord_test || tex_coord_test(i.texture, j.texture, edge.texture, registers_.formats))
            edge.tests |= datapath::tex_coord_bit;
        if (!tests.generation_test || generation_test(i, j, tests))
            edge.tests |= datapath::generation_bit;
    });
}

void TexCoordTest::b_transport(Work& work, sc_core::sc_time& delay) {
    process(work);
    delay += clock_.period() * timing_.latency;
    output->b_transport(work, delay);
}

void TexCoordTest::show(Signals& signals) const {
    WorkStage::show(signals);
    signals.value("generation_limit", 32, registers_.tests.generation_limit);
}

void TexCoordTest::trace_item(Signals& signals, const Work& work) const {
    const unsigned tests = Signals::pass_of(work).edges[Signals::index_of(work)].tests;
    signals.edge_textures(work);
    signals.value("generation_i", 8, Signals::begin_of(work).generation);
    signals.value("generation_j", 8, Signals::end_of(work).generation);
    signals.value("generation_ij", 8, inserted_generation(Signals::begin_of(work), Signals::end_of(work)));
    signals.flag("tex_coord", (tests & datapath::tex_coord_bit) != 0);
    signals.flag("generation", (tests & datapath::generation_bit) != 0);
}

}  // namespace tessera
