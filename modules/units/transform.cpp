#include "modules/units/transform.h"

#include "modules/datapath/transform.h"
#include "modules/unit/signals.h"

namespace tessera {

Transform::Transform(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                     const Timing& timing, unsigned pipelines, unsigned tests_units)
    : Stage(name, clock, timing.transform, pipelines),
      to_view_test("to_view_test", tests_units),
      registers_(registers) {
    takes_from(from_displace_vertex, timing.stalls);
    delivers_to(to_pass_or_tessellate);
    for (StreamOutput<Work>& output : to_view_test)
        delivers_to(output, vertex_parts);
}

Work Transform::process(const Work& part, const Entries&) {
    const datapath::TransformParameters& parameters = registers_.transform;
    const datapath::Formats& formats = registers_.formats;
    datapath::NewVertex& made = part.pass->new_vertex[part.index()];
    datapath::Vertex& vertex = part.pass->triangle.vertices[part.index()];
    if (part.is_edge()) {
        made.screen = datapath::transform(made.displaced, parameters, formats, saturations_);
        ++positions_;
    } else if (part.is_vertex()) {
        vertex.screen = datapath::transform(vertex.displaced, parameters, formats, saturations_);
        ++positions_;
    } else if (part.is_normal()) {
        vertex.screen_normal =
            datapath::transform_normal(vertex.displaced_normal, parameters, formats, saturations_);
        ++normals_;
    }
    return part;
}

void Transform::trace_processed(Signals& signals, const Work& work, const Work&) const {
    const datapath::NewVertex& made = Signals::pass_of(work).new_vertex[work.index()];
    const datapath::Vertex& vertex = Signals::begin_of(work);
    const bool edge = work.is_edge();
    signals.position("displaced_x", "displaced_y", "displaced_z", edge ? made.displaced : vertex.displaced);
    signals.screen("screen_x", "screen_y", edge ? made.screen : vertex.screen);
    signals.value("w", 32, static_cast<std::uint64_t>((edge ? made.screen : vertex.screen).w));
}

}  // namespace tessera
