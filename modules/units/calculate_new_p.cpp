#include "modules/units/calculate_new_p.h"

#include "modules/datapath/midpoint.h"

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

}  // namespace tessera
