#include "modules/units/displace_vertex.h"

#include "modules/datapath/displace.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/normalise.h"
#include "modules/unit/signals.h"

namespace tessera {

DisplaceVertex::DisplaceVertex(const sc_core::sc_module_name& name, Clock& clock,
                               const datapath::Registers& registers, const Timing& timing,
                               bool use_direct_memory)
    : Stage(name, clock, timing.displace_vertex, 1, timing.displacement_map.latency),
      displacement_map("displacement_map", registers.displacement_map.entry_bytes, use_direct_memory),
      registers_(registers) {
    takes_from(from_calculate_new_p, timing.stalls);
    delivers_to(to_transform);
    reads_through(displacement_map, 1);
}

void DisplaceVertex::reads(const Work& part, Reads& reads) const {
    if (part.is_normal())
        return;
    const datapath::TexCoord& t = part.is_edge() ? part.pass->new_vertex[part.index()].texture
                                                 : part.pass->triangle.vertices[part.index()].texture;
    reads.add(texel_address(t, registers_.displacement_map, registers_.map, registers_.formats));
}

Work DisplaceVertex::process(const Work& part, const Entries& codes) {
    const datapath::Formats& formats = registers_.formats;
    const auto code = static_cast<std::uint32_t>(codes[0]);
    if (part.is_edge()) {
        datapath::NewVertex& made = part.pass->new_vertex[part.index()];
        const datapath::Direction normal = normalise(made.mean_normal, formats, saturations_);
        made.displaced =
            displace(made.position, normal, code, registers_.displacement, formats, saturations_);
    } else if (part.is_vertex()) {
        datapath::Vertex& vertex = part.pass->triangle.vertices[part.index()];
        vertex.displaced =
            displace(vertex.position, vertex.normal, code, registers_.displacement, formats, saturations_);
    }
    return part;
}

void DisplaceVertex::trace_started(Signals& signals, const Work& part) const {
    const datapath::NewVertex& made = Signals::pass_of(part).new_vertex[part.index()];
    const datapath::Vertex& vertex = Signals::begin_of(part);
    signals.texture("t_u", "t_v", part.is_edge() ? made.texture : vertex.texture);
    signals.position("p_x", "p_y", "p_z", part.is_edge() ? made.position : vertex.position);
}

void DisplaceVertex::trace_processed(Signals& signals, const Work& part, const Work&) const {
    signals.position("displaced_x", "displaced_y", "displaced_z",
                     part.is_edge() ? Signals::pass_of(part).new_vertex[part.index()].displaced
                                    : Signals::begin_of(part).displaced);
}

}  // namespace tessera
