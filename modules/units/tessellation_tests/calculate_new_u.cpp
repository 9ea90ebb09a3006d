#include "modules/units/tessellation_tests/calculate_new_u.h"

#include "modules/datapath/midpoint.h"
#include "modules/unit/signals.h"

namespace tessera {

CalculateNewU::CalculateNewU(const sc_core::sc_module_name& name, Clock& clock, const Timing& timing)
    : WorkStage(name, clock, timing.calculate_new_u) {
    takes_from(input, timing.stalls);
    input.serve<&CalculateNewU::b_transport>(*this);
    delivers_to(to_normal_test);
    delivers_to(to_tex_coord_test);
    delivers_to(to_summed_height_test);
    delivers_to(to_view_test);
}

void CalculateNewU::process(const Work& work) {
    Pass& pass = *work.pass;
    for_each_of_three(work.parts, first_edge_part, [&](unsigned k) {
        const int edge = static_cast<int>(k);
        pass.edges[k].tests = 0;
        pass.edges[k].texture = midpoint(pass.edge_begin(edge).texture, pass.edge_end(edge).texture);
    });
}

unsigned CalculateNewU::targets(const Work& work) const {
    return (work.parts & edge_parts) != 0 ? 15u : 1u;  // a vertex goes to the Normal Test alone
}

void CalculateNewU::b_transport(Work& work, sc_core::sc_time& delay) {
    process(work);
    delay += clock_.period() * timing_.latency;
    // The four tests work side by side, from the same time on.
    for (StreamOutput<Work>* test : {&to_normal_test, &to_tex_coord_test, &to_summed_height_test}) {
        sc_core::sc_time its_delay = delay;
        (*test)->b_transport(work, its_delay);
    }
    to_view_test->b_transport(work, delay);
}

void CalculateNewU::trace_item(Signals& signals, const Work& work) const {
    signals.edge_textures(work);
}

}  // namespace tessera
