#include "modules/units/transform.h"

#include "modules/datapath/transform.h"

namespace tessera {

Transform::Transform(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                     const Timing& timing)
    : sc_module(name), registers_(registers), latency_(timing.cycle * timing.transform.latency) {
    from_displace_vertex.register_b_transport(this, &Transform::b_transport);
}

void Transform::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    const datapath::TransformParameters& parameters = registers_.transform;
    const datapath::Formats& formats = registers_.formats;
    for (std::size_t k = 0; k < 3; ++k) {
        datapath::Vertex& vertex = pass.triangle.vertices[k];
        if ((pass.new_vertices >> k & 1u) != 0) {
            vertex.screen = datapath::transform(vertex.displaced, parameters, formats, saturations_);
            ++positions_;
        }
        if ((pass.new_normals >> k & 1u) != 0) {
            vertex.screen_normal =
                datapath::transform_normal(vertex.displaced_normal, parameters, formats, saturations_);
            ++normals_;
        }
    }
    delay += latency_;
    if (pass.new_vertices != 0)
        to_view_test->b_transport(pass, delay);
    if (pass.tested) {
        for (datapath::NewVertex& made : pass.new_vertex)
            made.screen = datapath::transform(made.displaced, parameters, formats, saturations_);
        positions_ += 3;
    }
    to_pass_or_tessellate->b_transport(pass, delay);
}

}  // namespace tessera
