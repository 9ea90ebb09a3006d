#include "modules/units/lighting.h"

#include "modules/datapath/light.h"
#include "modules/unit/signals.h"
#include "modules/unit/stage_steps.h"

namespace tessera {

template class Stage<datapath::Triangle, LitTriangle>;

Lighting::Lighting(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                   const Timing& timing)
    : Stage(name, clock, timing.lighting), registers_(registers) {
    takes_from(from_pass_or_tessellate, timing.stalls);
    delivers_to(to_rasteriser);
}

LitTriangle Lighting::process(const datapath::Triangle& triangle, const Entries&) {
    clock_.progress();
    LitTriangle lit;
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::Vertex& vertex = triangle.vertices[k];
        if (!vertex.screen_normal_known)
            SC_REPORT_ERROR("tessera/lighting", "a triangle came without its normals in screen space");
        lit.corners[k] = {
            vertex.screen, vertex.texture,
            datapath::light(vertex.screen_normal, registers_.light, registers_.formats, saturations_)};
    }
    return lit;
}

void Lighting::trace_processed(Signals& signals, const datapath::Triangle&, const LitTriangle& lit) const {
    signals.screen("screen_0_x", "screen_0_y", lit.corners[0].screen);
    signals.screen("screen_1_x", "screen_1_y", lit.corners[1].screen);
    signals.screen("screen_2_x", "screen_2_y", lit.corners[2].screen);
    signals.value("intensity_0", 8, lit.corners[0].intensity);
    signals.value("intensity_1", 8, lit.corners[1].intensity);
    signals.value("intensity_2", 8, lit.corners[2].intensity);
}

}  // namespace tessera
