#include "modules/units/calculate_new_p.h"

#include "modules/datapath/midpoint.h"
#include "modules/stage/stage_steps.h"

namespace tessera {

CalculateNewP::CalculateNewP(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, context.timing().calculate_new_p), registers_(context.registers) {
    takes_from(context, from_get_triangle);
    delivers_to(context, to_displace_vertex);
}

BasePoint CalculateNewP::process(const GeometryOperands& part, const Entries&) {
    if (!part.tag.is_edge())
        return {part.tag, part.p_i, part.n_i, part.t_i, part.n_j, part.handedness};
    const datapath::Position p = midpoint(part.p_i, part.p_j);
    const datapath::TexCoord t = midpoint(part.t_i, part.t_j);
    if (registers_.formats.families)
        return {part.tag, p, part.n_i, t, part.n_j};
    return {part.tag, p, midpoint(part.n_i, part.n_j), t};
}

}  // namespace tessera
