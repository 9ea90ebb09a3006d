#include "modules/units/tessellation_tests/tessellation_tests.h"

namespace tessera {

TessellationTests::TessellationTests(const sc_core::sc_module_name& name, Clock& clock,
                                     const datapath::Registers& registers, const Timing& timing,
                                     unsigned number, unsigned units, bool use_direct_memory)
    : sc_module(name),
      calculate_new_u("calculate_new_u", clock, timing),
      tex_coord_test("tex_coord_test", clock, registers, timing),
      summed_height_test("summed_height_test", clock, registers, timing, use_direct_memory),
      normal_test("normal_test", clock, registers, timing, use_direct_memory, parts_for_tests(number, units)),
      view_test("view_test", clock, registers, timing, parts_for_tests(number, units)),
      collect_tests("collect_tests", clock, registers, timing) {}

void TessellationTests::wire(Wiring& wiring) {
    wiring.join(calculate_new_u.to_tex_coord_test, tex_coord_test.input);
    wiring.join(calculate_new_u.to_summed_height_test, summed_height_test.input);
    wiring.join(calculate_new_u.to_normal_test, normal_test.input);
    wiring.join(calculate_new_u.to_view_test, view_test.input);
    wiring.join(tex_coord_test.output, collect_tests.from_tex_coord_test);
    wiring.join(summed_height_test.output, collect_tests.from_summed_height_test);
    wiring.join(normal_test.output, collect_tests.from_normal_test);
    wiring.join(view_test.output, collect_tests.from_view_test);
}

}  // namespace tessera
