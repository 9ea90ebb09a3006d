#include "modules/units/deciding_unit.h"

#include "modules/datapath/cull.h"
#include "modules/datapath/edge_tests.h"
#include "modules/datapath/rank.h"

namespace tessera {

DecidingUnit::DecidingUnit(const sc_core::sc_module_name& name, const UnitContext& context)
    : Unit(name, context.clock),
      registers_(context.registers),
      timing_(context.timing().pass_or_tessellate),
      latency_(clock_.period() * timing_.latency) {
    to_lighting.clocked_by(context, *this);
    if (registers_.back_face_culling)
        area_.multiply(datapath::faces_away_multiplications(registers_.formats));
}

DecidingUnit::~DecidingUnit() = default;

void DecidingUnit::decide_edges(datapath::TrianglePass& pass) {
    ++counts_.passes;
    unsigned asked = 0;
    unsigned stopped_by = 0;
    for (unsigned k = 0; k < 3; ++k) {
        const datapath::EdgeTests& edge = pass.edges[k];
        if ((pass.triangle.final_edges >> k & 1u) != 0)
            continue;
        if ((pass.shared >> k & 1u) == 0)
            ++counts_.edges_tested;
        if (pass.told == datapath::Told::all && !(edge.texture == pass.new_vertex[k].texture))
            SC_REPORT_ERROR("tessera/pass_or_tessellate", "the two branches disagree on the midpoint of an edge");
        if (datapath::split_decision(edge.tests))
            asked |= 1u << k;
        else if ((edge.tests & datapath::requesting_tests) != 0)
            stopped_by |= ~edge.tests & datapath::gating_tests;
    }
    const unsigned split = datapath::edges_to_split(asked, registers_.triangulation, pass);
    counts_.edges_split += static_cast<unsigned>(__builtin_popcount(split));
    counts_.edges_uncut += static_cast<unsigned>(__builtin_popcount(asked & ~split));
    pass.split = static_cast<std::uint8_t>(split);
    pass.triangle.stopped_by = static_cast<std::uint8_t>(stopped_by);
}

DecidingUnit::Way DecidingUnit::finish(datapath::Triangle& triangle) {
    triangle.finished = true;
    ++counts_.finished;
    finished.write(triangle);
    const auto& v = triangle.vertices;
    if (registers_.back_face_culling && datapath::faces_away(v[0].screen, v[1].screen, v[2].screen)) {
        ++counts_.culled;
        return Way::dropped;
    }
    return Way::lighting;
}

TriangleToLight DecidingUnit::to_light(const Origin& origin, const datapath::Triangle& triangle) {
    TriangleToLight lit{origin, {}};
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::Vertex& vertex = triangle.vertices[k];
        lit.corners[k] = {vertex.screen, vertex.screen_normal, vertex.texture};
    }
    return lit;
}

}  // namespace tessera
