#include "modules/units/lighting.h"

#include "modules/datapath/light.h"

namespace tessera {

Lighting::Lighting(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                   const Timing& timing)
    : sc_module(name), registers_(registers), latency_(timing.cycle * timing.lighting.latency) {
    from_pass_or_tessellate.register_b_transport(this, &Lighting::b_transport);
}

void Lighting::b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    LitTriangle lit;
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::Vertex& vertex = triangle.vertices[k];
        if (!vertex.screen_normal_known)
            SC_REPORT_ERROR("tessera/lighting", "a triangle came without its normals in screen space");
        lit.corners[k] = {vertex.screen, vertex.texture,
                          datapath::light(vertex.screen_normal, registers_.light, registers_.formats)};
    }
    delay += latency_;
    to_rasteriser->b_transport(lit, delay);
}

}  // namespace tessera
