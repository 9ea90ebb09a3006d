#include "modules/units/calculate_new_p.h"

#include "modules/datapath/midpoint.h"

namespace tessera {

CalculateNewP::CalculateNewP(const sc_core::sc_module_name& name, const Timing& timing)
    : sc_module(name), latency_(timing.cycle * timing.calculate_new_p.latency) {
    from_get_triangle.register_b_transport(this, &CalculateNewP::b_transport);
}

void CalculateNewP::process(datapath::TrianglePass& pass) {
    if (!pass.tested)
        return;
    for (int k = 0; k < 3; ++k) {
        const datapath::Vertex& i = pass.edge_begin(k);
        const datapath::Vertex& j = pass.edge_end(k);
        datapath::NewVertex& made = pass.new_vertex[static_cast<std::size_t>(k)];
        made.position = midpoint(i.position, j.position);
        made.mean_normal = midpoint(i.normal, j.normal);
        made.texture = midpoint(i.texture, j.texture);
    }
}

void CalculateNewP::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    process(pass);
    delay += latency_;
    to_displace_vertex->b_transport(pass, delay);
}

}  // namespace tessera
