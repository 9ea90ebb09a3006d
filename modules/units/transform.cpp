#include "modules/units/transform.h"

#include "modules/datapath/transform.h"
#include "modules/unit/signals.h"

namespace tessera {

Transform::Transform(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                     const Timing& timing, unsigned pipelines, unsigned tests_units)
    : WorkStage(name, clock, timing.transform, pipelines),
      to_view_test("to_view_test", tests_units),
      registers_(registers),
      pipelines_(pipelines) {
    takes_from(from_displace_vertex, timing.stalls);
    from_displace_vertex.serve<&Transform::b_transport>(*this);
    delivers_to(to_pass_or_tessellate);
    for (StreamOutput<Work>& output : to_view_test)
        delivers_to(output);
}

void Transform::process(const Work& work) {
    const datapath::TransformParameters& parameters = registers_.transform;
    const datapath::Formats& formats = registers_.formats;
    Pass& pass = *work.pass;
    for_each_of_three(work.parts, 0, [&](unsigned k) {
        datapath::Vertex& vertex = pass.triangle.vertices[k];
        vertex.screen = datapath::transform(vertex.displaced, parameters, formats, saturations_);
        ++positions_;
    });
    for_each_of_three(work.parts, first_normal_part, [&](unsigned k) {
        datapath::Vertex& vertex = pass.triangle.vertices[k];
        vertex.screen_normal =
            datapath::transform_normal(vertex.displaced_normal, parameters, formats, saturations_);
        ++normals_;
    });
    for_each_of_three(work.parts, first_edge_part, [&](unsigned k) {
        datapath::NewVertex& made = pass.new_vertex[k];
        made.screen = datapath::transform(made.displaced, parameters, formats, saturations_);
        ++positions_;
    });
}

unsigned Transform::targets(const Work& work) const {
    return (work.parts & vertex_parts) != 0 ? ~0u : 1u;
}

void Transform::b_transport(Work& work, sc_core::sc_time& delay) {
    process(work);
    delay += clock_.period() * timing_.latency;
    if ((work.parts & vertex_parts) != 0)
        to_view_test[0]->b_transport(work, delay);
    to_pass_or_tessellate->b_transport(work, delay);
}

void Transform::trace_item(Signals& signals, const Work& work) const {
    const datapath::NewVertex& made = Signals::pass_of(work).new_vertex[Signals::index_of(work)];
    const datapath::Vertex& vertex = Signals::begin_of(work);
    const bool edge = Signals::is_edge(work);
    signals.position("displaced_x", "displaced_y", "displaced_z", edge ? made.displaced : vertex.displaced);
    signals.screen("screen_x", "screen_y", edge ? made.screen : vertex.screen);
    signals.value("w", 32, static_cast<std::uint64_t>((edge ? made.screen : vertex.screen).w));
}

}  // namespace tessera
