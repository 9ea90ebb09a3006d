#include "modules/units/displace_vertex.h"

#include "modules/datapath/displace.h"
#include "modules/datapath/map_address.h"
#include "modules/datapath/normalise.h"
#include "modules/unit/signals.h"

namespace tessera {

DisplaceVertex::DisplaceVertex(const sc_core::sc_module_name& name, Clock& clock,
                               const datapath::Registers& registers, const Timing& timing,
                               bool use_direct_memory)
    : TableStage(name, clock, timing.displace_vertex, timing.displacement_map.latency),
      displacement_map("displacement_map", registers.displacement_map.entry_bytes, use_direct_memory),
      registers_(registers) {
    takes_from(from_calculate_new_p, timing.stalls);
    delivers_to(to_transform);
    reads_through(displacement_map, 1);
    from_calculate_new_p.serve<&DisplaceVertex::b_transport>(*this);
}

std::uint64_t DisplaceVertex::address(const datapath::TexCoord& t) const {
    return texel_address(t, registers_.displacement_map, registers_.map, registers_.formats);
}

void DisplaceVertex::displace_vertex(datapath::Vertex& vertex, std::uint64_t code) {
    vertex.displaced = displace(vertex.position, vertex.normal, static_cast<std::uint32_t>(code),
                                registers_.displacement, registers_.formats, saturations_);
}

void DisplaceVertex::displace_edge(datapath::NewVertex& made, std::uint64_t code) {
    const datapath::Direction normal = normalise(made.mean_normal, registers_.formats, saturations_);
    made.displaced = displace(made.position, normal, static_cast<std::uint32_t>(code),
                              registers_.displacement, registers_.formats, saturations_);
}

void DisplaceVertex::b_transport(Work& work, sc_core::sc_time& delay) {
    Pass& pass = *work.pass;
    for_each_of_three(work.parts, 0, [&](unsigned k) {
        datapath::Vertex& vertex = pass.triangle.vertices[k];
        displace_vertex(vertex, displacement_map.read(address(vertex.texture), delay));
    });
    for_each_of_three(work.parts, first_edge_part, [&](unsigned k) {
        datapath::NewVertex& made = pass.new_vertex[k];
        displace_edge(made, displacement_map.read(address(made.texture), delay));
    });
    delay += clock_.period() * timing_.latency;
    to_transform->b_transport(work, delay);
}

unsigned DisplaceVertex::begin(TableItem& item) {
    return (item.work.parts & normal_parts) == 0 ? 1 : 0;
}

void DisplaceVertex::ask(TableItem& item, unsigned) {
    const Pass& pass = *item.work.pass;
    const auto ask_at = [&](const datapath::TexCoord& t) {
        const std::uint64_t at = address(t);
        displacement_map.request(&at, 1);
    };
    for_each_of_three(item.work.parts, 0, [&](unsigned k) { ask_at(pass.triangle.vertices[k].texture); });
    for_each_of_three(item.work.parts, first_edge_part,
                      [&](unsigned k) { ask_at(pass.new_vertex[k].texture); });
}

void DisplaceVertex::receive(TableItem& item, unsigned) {
    Pass& pass = *item.work.pass;
    const std::uint64_t code = displacement_map.entry(0);
    for_each_of_three(item.work.parts, 0,
                      [&](unsigned k) { displace_vertex(pass.triangle.vertices[k], code); });
    for_each_of_three(item.work.parts, first_edge_part,
                      [&](unsigned k) { displace_edge(pass.new_vertex[k], code); });
}

void DisplaceVertex::trace_item(Signals& signals, const TableItem& item) const {
    const datapath::NewVertex& made = Signals::pass_of(item.work).new_vertex[Signals::index_of(item.work)];
    const datapath::Vertex& vertex = Signals::begin_of(item.work);
    const bool edge = Signals::is_edge(item.work);
    signals.texture("t_u", "t_v", edge ? made.texture : vertex.texture);
    signals.position("p_x", "p_y", "p_z", edge ? made.position : vertex.position);
}

void DisplaceVertex::trace_answered(Signals& signals, const TableItem& item) const {
    const unsigned k = Signals::index_of(item.work);
    signals.position("displaced_x", "displaced_y", "displaced_z",
                     Signals::is_edge(item.work) ? Signals::pass_of(item.work).new_vertex[k].displaced
                                                 : Signals::begin_of(item.work).displaced);
}

}  // namespace tessera
