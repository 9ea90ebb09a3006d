#include "modules/units/calculate_new_p.h"

#include "modules/datapath/midpoint.h"
#include "modules/unit/signals.h"

namespace tessera {

CalculateNewP::CalculateNewP(const sc_core::sc_module_name& name, Clock& clock, const Timing& timing)
    : WorkStage(name, clock, timing.calculate_new_p) {
    takes_from(from_get_triangle, timing.stalls);
    delivers_to(to_displace_vertex);
    from_get_triangle.serve<&CalculateNewP::b_transport>(*this);
}

void CalculateNewP::process(const Work& work) {
    Pass& pass = *work.pass;
    for_each_of_three(work.parts, first_edge_part, [&](unsigned k) {
        const datapath::Vertex& i = pass.edge_begin(static_cast<int>(k));
        const datapath::Vertex& j = pass.edge_end(static_cast<int>(k));
        datapath::NewVertex& made = pass.new_vertex[k];
        made.position = midpoint(i.position, j.position);
        made.mean_normal = midpoint(i.normal, j.normal);
        made.texture = midpoint(i.texture, j.texture);
    });
}

void CalculateNewP::b_transport(Work& work, sc_core::sc_time& delay) {
    process(work);
    delay += clock_.period() * timing_.latency;
    to_displace_vertex->b_transport(work, delay);
}

void CalculateNewP::trace_item(Signals& signals, const Work& work) const {
    const datapath::Vertex& begin = Signals::begin_of(work);
    const datapath::Vertex& end = Signals::end_of(work);
    signals.texture("t_i_u", "t_i_v", begin.texture);
    signals.texture("t_j_u", "t_j_v", end.texture);
    signals.position("p_i_x", "p_i_y", "p_i_z", begin.position);
    signals.position("p_j_x", "p_j_y", "p_j_z", end.position);
    signals.position("p_ij_x", "p_ij_y", "p_ij_z",
                     Signals::pass_of(work).new_vertex[Signals::index_of(work)].position);
}

}  // namespace tessera
