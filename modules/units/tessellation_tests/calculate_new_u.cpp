#include "modules/units/tessellation_tests/calculate_new_u.h"

#include "modules/datapath/midpoint.h"

namespace tessera {

CalculateNewU::CalculateNewU(const sc_core::sc_module_name& name, const Timing& timing)
    : sc_module(name), latency_(timing.cycle * timing.calculate_new_u.latency) {
    input.register_b_transport(this, &CalculateNewU::b_transport);
}

void CalculateNewU::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    for (int k = 0; k < 3; ++k)
        pass.edges[static_cast<std::size_t>(k)].texture =
            midpoint(pass.edge_begin(k).texture, pass.edge_end(k).texture);
    delay += latency_;
}

}  // namespace tessera
