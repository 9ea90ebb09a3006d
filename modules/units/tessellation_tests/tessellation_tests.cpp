#include "modules/units/tessellation_tests/tessellation_tests.h"

namespace tessera {

TessellationTests::TessellationTests(const sc_core::sc_module_name& name, Clock& clock,
                                     const datapath::Registers& registers, const Timing& timing,
                                     unsigned number, bool use_direct_memory)
    : sc_module(name),
      calculate_new_u("calculate_new_u", clock, timing),
      tex_coord_test("tex_coord_test", clock, registers, timing),
      summed_height_test("summed_height_test", clock, registers, timing, use_direct_memory),
      normal_test("normal_test", clock, registers, timing, use_direct_memory),
      view_test("view_test", clock, registers, timing, number),
      collect_tests("collect_tests", clock, registers, timing) {
    calculate_new_u.to_tex_coord_test.bind(tex_coord_test.input);
    calculate_new_u.to_summed_height_test.bind(summed_height_test.input);
    calculate_new_u.to_normal_test.bind(normal_test.input);
    calculate_new_u.to_view_test.bind(view_test.input);
    tex_coord_test.output.bind(collect_tests.from_tex_coord_test);
    summed_height_test.output.bind(collect_tests.from_summed_height_test);
    normal_test.output.bind(collect_tests.from_normal_test);
    view_test.output.bind(collect_tests.from_view_test);
}

}  // namespace tessera
