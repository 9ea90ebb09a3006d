#include "modules/tessellation_tests.h"

#include <string>

namespace tessera {

TessellationTests::TessellationTests(const sc_core::sc_module_name& name, const UnitContext& context,
                                     UnitFactory& factory, std::vector<Unit*>& units)
    : sc_module(name), made_(context, factory, units) {
    for (unsigned k = 1; k < context.design.edge_lanes; ++k) {
        const std::string number = "_" + std::to_string(k);
        lanes_.push_back({made_.make<CalculateNewU>("calculate_new_u" + number),
                          made_.make<TexCoordTest>("tex_coord_test" + number),
                          made_.make<ViewTest>("view_test" + number)});
    }
    for (unsigned k = 1; k < context.design.normal_tests; ++k)
        normal_tests_.push_back(&made_.make<NormalTest>("normal_test_" + std::to_string(k)));
}

StreamOutput<TestedEdge>& TessellationTests::to_pass_or_tessellate(std::size_t lane) const {
    if (collect_tests != nullptr)
        return collect_tests->to_pass_or_tessellate;
    return sequence_tests != nullptr ? sequence_tests->to_pass_or_tessellate
                                     : family_sequence_tests->to_pass_or_tessellate[lane];
}

void TessellationTests::attach(CycleScheduler& clock) {
    clock.attach(collector);
    for (const Lane& lane : lanes_)
        clock.attach(lane.view_test);
    for (NormalTest* test : normal_tests_)
        clock.attach(*test);
    clock.attach(height_test);
    for (const Lane& lane : lanes_)
        clock.attach(lane.tex_coord_test);
    for (const Lane& lane : lanes_)
        clock.attach(lane.calculate_new_u);
}

void TessellationTests::wire() {
    if (family_sequence_tests != nullptr) {
        wire_lanes();
        return;
    }
    calculate_new_u.to_tex_coord_test.bind(tex_coord_test.input);
    calculate_new_u.to_view_test.bind(view_test.input);
    if (sequence_tests == nullptr) {
        calculate_new_u.to_summed_height_test.bind(height_test.input);
        calculate_new_u.to_normal_test.bind(normal_test.input);
        take_results(*collect_tests);
    } else {
        calculate_new_u.to_summed_height_test.bind(sequence_tests->height_operands);
        calculate_new_u.to_normal_test.bind(sequence_tests->normal_operands);
        sequence_tests->to_summed_height_test.bind(height_test.input);
        sequence_tests->to_normal_test.bind(normal_test.input);
        take_results(*sequence_tests);
    }
}

void TessellationTests::wire_lanes() {
    FamilySequenceTests& sequence = *family_sequence_tests;
    for (std::size_t k = 0; k < lanes_.size(); ++k) {
        const Lane& lane = lanes_[k];
        lane.calculate_new_u.to_tex_coord_test.bind(lane.tex_coord_test.input);
        lane.calculate_new_u.to_view_test.bind(lane.view_test.input);
        lane.calculate_new_u.to_summed_height_test.bind(sequence.height_operands[k]);
        lane.calculate_new_u.to_normal_test.bind(sequence.normal_operands[k]);
        lane.tex_coord_test.output.bind(sequence.from_tex_coord_test[k]);
        lane.view_test.output.bind(sequence.from_view_test[k]);
    }
    for (std::size_t k = 0; k < normal_tests_.size(); ++k) {
        sequence.to_normal_test[k].bind(normal_tests_[k]->input);
        normal_tests_[k]->output.bind(sequence.from_normal_test[k]);
    }
    sequence.to_summed_height_test.bind(height_test.input);
    height_test.output.bind(sequence.from_summed_height_test);
}

template <class Collector>
void TessellationTests::take_results(Collector& its) {
    tex_coord_test.output.bind(its.from_tex_coord_test);
    height_test.output.bind(its.from_summed_height_test);
    normal_test.output.bind(its.from_normal_test);
    view_test.output.bind(its.from_view_test);
}

}  // namespace tessera
