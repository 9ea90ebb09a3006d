#include "modules/units/tessellation.h"

#include "modules/datapath/tessellate.h"

namespace tessera {

Tessellation::Tessellation(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                           const Timing& timing)
    : sc_module(name), registers_(registers), latency_(timing.cycle * timing.tessellation.latency) {
    from_pass_or_tessellate.register_b_transport(this, &Tessellation::b_transport);
}

void Tessellation::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    delay += latency_;
    const int children = tessellate(pass, registers_.triangulation, [&](datapath::Triangle& child) {
        to_triangle_queue->b_transport(child, delay);
    });
    ++made_into_[static_cast<std::size_t>(children)];
}

}  // namespace tessera
