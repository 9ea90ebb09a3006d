#include "modules/units/tessellation_tests/tex_coord_test.h"

#include "modules/datapath/edge_tests.h"

namespace tessera {

TexCoordTest::TexCoordTest(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                           const Timing& timing)
    : sc_module(name), registers_(registers), latency_(timing.cycle * timing.tex_coord_test.latency) {
    input.register_b_transport(this, &TexCoordTest::b_transport);
}

void TexCoordTest::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    const datapath::TestParameters& tests = registers_.tests;
    for (int k = 0; k < 3; ++k) {
        const datapath::Vertex& i = pass.edge_begin(k);
        const datapath::Vertex& j = pass.edge_end(k);
        datapath::EdgeTests& edge = pass.edges[static_cast<std::size_t>(k)];
        if (!tests.tex_coord_test || tex_coord_test(i.texture, j.texture, edge.texture, registers_.formats))
            edge.tests |= datapath::tex_coord_bit;
        if (!tests.generation_test || generation_test(i, j, tests))
            edge.tests |= datapath::generation_bit;
    }
    delay += latency_;
}

}  // namespace tessera
