#include "modules/units/edge_tests/calculate_new_u.h"

#include "modules/datapath/midpoint.h"
#include "modules/stage/stage_steps.h"

namespace tessera {
namespace {

NormalOperands for_normal_test(const EdgeToTest& edge) {
    const EdgeEnd& i = edge.ends[0];
    const EdgeEnd& j = edge.ends[1];
    return {edge.tag,  edge.new_vertices, edge.t_ij,    i.n,           j.n,          i.tangent,
            j.tangent, i.handedness,      j.handedness, i.displaced_n, j.displaced_n};
}

TexCoordOperands for_tex_coord_test(const EdgeToTest& edge) {
    const EdgeEnd& i = edge.ends[0];
    const EdgeEnd& j = edge.ends[1];
    return {edge.tag, i.t, j.t, edge.t_ij, i.generation, j.generation};
}

HeightOperands for_summed_height_test(const EdgeToTest& edge) {
    const EdgeEnd& i = edge.ends[0];
    const EdgeEnd& j = edge.ends[1];
    return {{i.t, j.t, edge.t_ij, edge.new_vertices == 0, i.code, j.code, {}}, edge.tag};
}

ViewOperands for_view_test(const EdgeToTest& edge) {
    return {edge.tag, edge.new_vertices, edge.ends[0].screen, edge.ends[1].screen};
}

}  // namespace

CalculateNewU::CalculateNewU(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, context.timing().calculate_new_u) {
    takes_from(context, input);
    delivers_to(context, to_normal_test, for_normal_test, all_parts);
    delivers_to(context, to_tex_coord_test, for_tex_coord_test, edge_parts);
    delivers_to(context, to_summed_height_test, for_summed_height_test, edge_parts);
    delivers_to(context, to_view_test, for_view_test, edge_parts);
    keeps(2 * context.registers.formats.texture.bits);
}

EdgeToTest CalculateNewU::process(const TestOperands& part, const Entries&) {
    const datapath::TexCoord& t_i = part.ends[0].t;
    return {part, part.tag.is_edge() ? midpoint(t_i, part.ends[1].t) : t_i};
}

}  // namespace tessera
