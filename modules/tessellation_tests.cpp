#include "modules/tessellation_tests.h"

namespace tessera {

TessellationTests::Units TessellationTests::make(const UnitContext& context, UnitFactory& factory, unsigned number) {
    const Parts takes = parts_for_tests(number, context.design.tests_units);
    Units made;
    made.calculate_new_u = factory.calculate_new_u("calculate_new_u", context);
    made.tex_coord_test = factory.tex_coord_test("tex_coord_test", context);
    made.summed_height_test = factory.summed_height_test("summed_height_test", context);
    made.normal_test = factory.normal_test("normal_test", context, takes);
    made.view_test = factory.view_test("view_test", context, takes);
    if (context.design.test_order == TestOrder::parallel)
        made.collect_tests = factory.collect_tests("collect_tests", context);
    else
        made.sequence_tests = factory.sequence_tests("sequence_tests", context);
    return made;
}

TessellationTests::TessellationTests(const sc_core::sc_module_name& name, const UnitContext& context,
                                     UnitFactory& factory, unsigned number)
    : sc_module(name), made_(make(context, factory, number)) {}

void TessellationTests::wire() {
    calculate_new_u.to_tex_coord_test.bind(tex_coord_test.input);
    calculate_new_u.to_view_test.bind(view_test.input);
    if (sequence_tests == nullptr) {
        calculate_new_u.to_summed_height_test.bind(summed_height_test.input);
        calculate_new_u.to_normal_test.bind(normal_test.input);
        take_results(*collect_tests);
    } else {
        calculate_new_u.to_summed_height_test.bind(sequence_tests->height_operands);
        calculate_new_u.to_normal_test.bind(sequence_tests->normal_operands);
        sequence_tests->to_summed_height_test.bind(summed_height_test.input);
        sequence_tests->to_normal_test.bind(normal_test.input);
        take_results(*sequence_tests);
    }
}

template <class Collector>
void TessellationTests::take_results(Collector& collector) {
    tex_coord_test.output.bind(collector.from_tex_coord_test);
    summed_height_test.output.bind(collector.from_summed_height_test);
    normal_test.output.bind(collector.from_normal_test);
    view_test.output.bind(collector.from_view_test);
}

}  // namespace tessera
