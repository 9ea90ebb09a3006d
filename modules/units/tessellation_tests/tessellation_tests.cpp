#include "modules/units/tessellation_tests/tessellation_tests.h"

#include <algorithm>

namespace tessera {

TessellationTests::TessellationTests(const sc_core::sc_module_name& name,
                                     const datapath::Registers& registers, const Timing& timing,
                                     bool use_direct_memory)
    : sc_module(name),
      calculate_new_u("calculate_new_u", timing),
      tex_coord_test("tex_coord_test", registers, timing),
      summed_height_test("summed_height_test", registers, timing, use_direct_memory),
      normal_test("normal_test", registers, timing, use_direct_memory),
      view_test("view_test", registers, timing) {
    from_get_triangle.register_b_transport(this, &TessellationTests::b_transport);
    to_calculate_new_u_.bind(calculate_new_u.input);
    to_tex_coord_test_.bind(tex_coord_test.input);
    to_summed_height_test_.bind(summed_height_test.input);
    to_normal_test_.bind(normal_test.input);
    to_view_test_.bind(view_test.input);
}

void TessellationTests::b_transport(datapath::TrianglePass& pass, sc_core::sc_time& delay) {
    for (datapath::EdgeTests& edge : pass.edges)
        edge.tests = 0;
    to_calculate_new_u_->b_transport(pass, delay);

    // The four tests work side by side: the slowest one's time counts.
    sc_core::sc_time tex_coord = delay, summed_height = delay, normal = delay, view = delay;
    to_tex_coord_test_->b_transport(pass, tex_coord);
    to_summed_height_test_->b_transport(pass, summed_height);
    to_normal_test_->b_transport(pass, normal);
    to_view_test_->b_transport(pass, view);
    delay = std::max(std::max(tex_coord, summed_height), std::max(normal, view));

    edges_tested_ += 3;
    to_pass_or_tessellate->b_transport(pass, delay);
}

}  // namespace tessera
