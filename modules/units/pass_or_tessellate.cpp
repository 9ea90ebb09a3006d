#include "modules/units/pass_or_tessellate.h"

#include <algorithm>

#include "modules/datapath/cull.h"
#include "modules/datapath/edge_tests.h"

namespace tessera {

PassOrTessellate::PassOrTessellate(const sc_core::sc_module_name& name, const datapath::Registers& registers,
                                   const Timing& timing)
    : sc_module(name), registers_(registers), latency_(timing.cycle * timing.pass_or_tessellate.latency) {
    from_transform.register_b_transport(this, &PassOrTessellate::b_transport);
    from_tessellation_tests.register_b_transport(this, &PassOrTessellate::b_transport);
}

void PassOrTessellate::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    if (!pass.tested) {
        join(pass, delay);
    } else if (waiting_ == nullptr) {
        waiting_ = &pass;
        waiting_delay_ = delay;
    } else {
        if (waiting_ != &pass)
            SC_REPORT_ERROR("tessera/pass_or_tessellate", "the two branches brought different triangles");
        waiting_ = nullptr;
        delay = std::max(delay, waiting_delay_);
        join(pass, delay);
    }
}

void PassOrTessellate::join(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    delay += latency_;
    datapath::Triangle& triangle = pass.triangle;
    for (unsigned k = 0; k < 3; ++k) {
        datapath::Vertex& vertex = triangle.vertices[k];
        vertex.displaced_known = true;
        if ((pass.new_normals >> k & 1u) != 0)
            vertex.screen_normal_known = true;
    }
    if (!pass.tested) {
        ++counts_.normal_passes;
        finish(triangle, delay);
        return;
    }
    decide_edges(pass);
    decided.write(pass);
    if (pass.split != 0) {
        to_tessellation->b_transport(pass, delay);
    } else if (pass.new_vertices != 0) {
        triangle.finished = true;
        to_tessellation->b_transport(pass, delay);
    } else {
        finish(triangle, delay);
    }
}

void PassOrTessellate::decide_edges(datapath::TrianglePass& pass) {
    ++counts_.passes;
    unsigned split = 0;
    unsigned stopped_by = 0;
    for (unsigned k = 0; k < 3; ++k) {
        const datapath::EdgeTests& edge = pass.edges[k];
        if (!(edge.texture == pass.new_vertex[k].texture))
            SC_REPORT_ERROR("tessera/pass_or_tessellate",
                            "the two branches disagree on the midpoint of an edge");
        const unsigned wanted = edge.tests & (datapath::normal_bit | datapath::summed_height_bit);
        if (datapath::split_decision(edge.tests)) {
            split |= 1u << k;
            ++counts_.edges_split;
            counts_.split_by_normal += wanted == datapath::normal_bit;
            counts_.split_by_summed_height += wanted == datapath::summed_height_bit;
            counts_.split_by_both += wanted == (datapath::normal_bit | datapath::summed_height_bit);
        } else if (wanted != 0) {
            const unsigned missing =
                ~edge.tests & (datapath::view_bit | datapath::tex_coord_bit | datapath::generation_bit);
            stopped_by |= missing;
            counts_.stopped_by_view += (missing & datapath::view_bit) != 0;
            counts_.stopped_by_tex_coord += (missing & datapath::tex_coord_bit) != 0;
            counts_.stopped_by_generation += (missing & datapath::generation_bit) != 0;
        }
    }
    pass.split = static_cast<std::uint8_t>(split);
    pass.triangle.stopped_by = static_cast<std::uint8_t>(stopped_by);
}

void PassOrTessellate::finish(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    triangle.finished = true;
    ++counts_.finished;
    finished.write(triangle);
    const auto& v = triangle.vertices;
    if (registers_.back_face_culling && datapath::faces_away(v[0].screen, v[1].screen, v[2].screen)) {
        ++counts_.culled;
        return;
    }
    to_lighting->b_transport(triangle, delay);
}

}  // namespace tessera
