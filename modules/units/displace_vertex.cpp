#include "modules/units/displace_vertex.h"

#include "modules/datapath/displace.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/normalise.h"

namespace tessera {

DisplaceVertex::DisplaceVertex(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                               const Timing& timing, bool use_direct_memory)
    : sc_module(name),
      displacement_map("displacement_map", registers.displacement_map.entry_bytes, use_direct_memory),
      registers_(registers),
      latency_(timing.cycle * timing.displace_vertex.latency) {
    from_calculate_new_p.register_b_transport(this, &DisplaceVertex::b_transport);
}

datapath::Position DisplaceVertex::displaced(const datapath::Position& p, const datapath::Direction& n,
                                             const datapath::TexCoord& t, sc_core::sc_time& delay) {
    const std::uint64_t code = displacement_map.read(
        texel_address(t, registers_.displacement_map, registers_.map, registers_.formats), delay);
    return displace(p, n, static_cast<std::uint32_t>(code), registers_.displacement, registers_.formats,
                    saturations_);
}

void DisplaceVertex::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    for (std::size_t k = 0; k < 3; ++k) {
        if ((pass.new_vertices >> k & 1u) == 0)
            continue;
        datapath::Vertex& vertex = pass.triangle.vertices[k];
        vertex.displaced = displaced(vertex.position, vertex.normal, vertex.texture, delay);
    }
    if (pass.tested) {
        for (datapath::NewVertex& made : pass.new_vertex) {
            const datapath::Direction normal = normalise(made.mean_normal, registers_.formats, saturations_);
            made.displaced = displaced(made.position, normal, made.texture, delay);
        }
    }
    delay += latency_;
    to_transform->b_transport(pass, delay);
}

}  // namespace tessera
