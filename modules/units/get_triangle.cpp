#include "modules/units/get_triangle.h"

#include <algorithm>

namespace tessera {

GetTriangle::GetTriangle(const sc_core::sc_module_name& name, const Timing& timing)
    : sc_module(name), latency_(timing.cycle * timing.get_triangle.latency) {
    from_host.register_b_transport(this, &GetTriangle::b_transport_from_host);
    from_triangle_queue.register_b_transport(this, &GetTriangle::b_transport_from_triangle_queue);
}

void GetTriangle::prepare(datapath::TrianglePass& pass) {
    pass.new_vertices = 0;
    pass.new_normals = 0;
    pass.split = 0;
    pass.tested = !pass.triangle.finished;
    for (unsigned k = 0; k < 3; ++k) {
        const datapath::Vertex& vertex = pass.triangle.vertices[k];
        if (!vertex.displaced_known)
            pass.new_vertices = static_cast<std::uint8_t>(pass.new_vertices | 1u << k);
        else if (!vertex.screen_normal_known)
            pass.new_normals = static_cast<std::uint8_t>(pass.new_normals | 1u << k);
    }
}

void GetTriangle::send(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    prepare(pass);
    delay += latency_;
    sc_core::sc_time geometry = delay;
    sc_core::sc_time tests = delay;
    to_calculate_new_p->b_transport(pass, geometry);
    if (pass.tested)
        to_tessellation_tests->b_transport(pass, tests);
    delay = std::max(geometry, tests);
}

void GetTriangle::b_transport_from_host(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    while (!queue_level->takes_host_triangles())
        wait(queue_level->host_may_send());
    ++host_triangles_;
    send(pass, delay);
}

void GetTriangle::b_transport_from_triangle_queue(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    ++queue_triangles_;
    send(pass, delay);
}

}  // namespace tessera
