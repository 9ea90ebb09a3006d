#include "modules/units/calculate_new_p.h"

#include "modules/datapath/midpoint.h"
#include "modules/unit/signals.h"

namespace tessera {

CalculateNewP::CalculateNewP(const sc_core::sc_module_name& name, Clock& clock, const Timing& timing)
    : Stage(name, clock, timing.calculate_new_p) {
    takes_from(from_get_triangle, timing.stalls);
    delivers_to(to_displace_vertex);
}

Work CalculateNewP::process(const Work& part, const Entries&) {
    if (part.is_edge()) {
        const int k = static_cast<int>(part.index());
        const datapath::Vertex& i = part.pass->edge_begin(k);
        const datapath::Vertex& j = part.pass->edge_end(k);
        datapath::NewVertex& made = part.pass->new_vertex[part.index()];
        made.position = midpoint(i.position, j.position);
        made.mean_normal = midpoint(i.normal, j.normal);
        made.texture = midpoint(i.texture, j.texture);
    }
    return part;
}

void CalculateNewP::trace_processed(Signals& signals, const Work& work, const Work&) const {
    const datapath::Vertex& begin = Signals::begin_of(work);
    const datapath::Vertex& end = Signals::end_of(work);
    signals.texture("t_i_u", "t_i_v", begin.texture);
    signals.texture("t_j_u", "t_j_v", end.texture);
    signals.position("p_i_x", "p_i_y", "p_i_z", begin.position);
    signals.position("p_j_x", "p_j_y", "p_j_z", end.position);
    signals.position("p_ij_x", "p_ij_y", "p_ij_z", Signals::pass_of(work).new_vertex[work.index()].position);
}

}  // namespace tessera
