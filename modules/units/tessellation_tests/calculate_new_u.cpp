#include "modules/units/tessellation_tests/calculate_new_u.h"

#include "modules/datapath/midpoint.h"
#include "modules/unit/signals.h"

namespace tessera {

CalculateNewU::CalculateNewU(const sc_core::sc_module_name& name, Clock& clock, const Timing& timing)
    : Stage(name, clock, timing.calculate_new_u) {
    takes_from(input, timing.stalls);
    delivers_to(to_normal_test);
    delivers_to(to_tex_coord_test, edge_parts);
    delivers_to(to_summed_height_test, edge_parts);
    delivers_to(to_view_test, edge_parts);
}

Work CalculateNewU::process(const Work& part, const Entries&) {
    if (part.is_edge()) {
        const int k = static_cast<int>(part.index());
        datapath::EdgeTests& edge = part.pass->edges[part.index()];
        edge.tests = 0;
        edge.texture = midpoint(part.pass->edge_begin(k).texture, part.pass->edge_end(k).texture);
    }
    return part;
}

void CalculateNewU::trace_processed(Signals& signals, const Work& work, const Work&) const {
    signals.edge_textures(work);
}

}  // namespace tessera
