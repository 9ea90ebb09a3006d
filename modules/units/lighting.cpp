#include "modules/units/lighting.h"

#include "modules/datapath/light.h"
#include "modules/stage/stage_steps.h"

namespace tessera {

Lighting::Lighting(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, context.timing().lighting), registers_(context.registers) {
    takes_from(context, from_pass_or_tessellate);
    delivers_to(context, to_rasteriser);
    constexpr unsigned corners = 3;
    multiplies(datapath::Multiplications().add(light_multiplications(registers_.formats), corners));
}

LitTriangle Lighting::process(const TriangleToLight& triangle, const Entries&) {
    clock_.progress();
    LitTriangle lit{triangle.origin, {}};
    for (std::size_t k = 0; k < 3; ++k) {
        const TriangleToLight::Corner& corner = triangle.corners[k];
        lit.corners[k] = {corner.screen, corner.t,
                          light(corner.screen_n, registers_.light, registers_.formats, saturations_)};
    }
    return lit;
}

}  // namespace tessera
