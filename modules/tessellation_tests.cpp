#include "modules/tessellation_tests.h"

#include <string>

namespace tessera {

TessellationTests::Units TessellationTests::make(const UnitContext& context, UnitFactory& factory) {
    Units made;
    made.calculate_new_u = factory.make<CalculateNewU>("calculate_new_u", context);
    made.tex_coord_test = factory.make<TexCoordTest>("tex_coord_test", context);
    made.height_test =
        factory.make<HeightTestUnit>(functions_of(context.registers.formats.height_test).unit().c_str(), context);
    made.normal_test = factory.make<NormalTest>("normal_test", context);
    made.view_test = factory.make<ViewTest>("view_test", context);
    if (context.design.test_order == TestOrder::parallel)
        made.collect_tests = factory.make<CollectTests>("collect_tests", context);
    else if (context.design.work == Work::triangle)
        made.sequence_tests = factory.make<SequenceTests>("sequence_tests", context);
    else
        made.family_sequence_tests = factory.make<FamilySequenceTests>("sequence_tests", context);
    const auto numbered = [](const char* name, unsigned k) { return std::string(name) + "_" + std::to_string(k); };
    for (unsigned k = 1; k < context.design.edge_lanes; ++k) {
        made.further_calculate_new_u.push_back(
            factory.make<CalculateNewU>(numbered("calculate_new_u", k).c_str(), context));
        made.further_tex_coord_tests.push_back(
            factory.make<TexCoordTest>(numbered("tex_coord_test", k).c_str(), context));
        made.further_view_tests.push_back(factory.make<ViewTest>(numbered("view_test", k).c_str(), context));
    }
    for (unsigned k = 1; k < context.design.normal_tests; ++k)
        made.further_normal_tests.push_back(factory.make<NormalTest>(numbered("normal_test", k).c_str(), context));
    return made;
}

TessellationTests::TessellationTests(const sc_core::sc_module_name& name, const UnitContext& context,
                                     UnitFactory& factory)
    : sc_module(name), made_(make(context, factory)) {
    lanes_.push_back({calculate_new_u, tex_coord_test, view_test});
    for (std::size_t k = 0; k < made_.further_calculate_new_u.size(); ++k)
        lanes_.push_back(
            {*made_.further_calculate_new_u[k], *made_.further_tex_coord_tests[k], *made_.further_view_tests[k]});
    normal_tests_.push_back(&normal_test);
    for (const auto& further : made_.further_normal_tests)
        normal_tests_.push_back(further.get());
}

Unit& TessellationTests::collector() const {
    if (collect_tests != nullptr)
        return *collect_tests;
    return sequence_tests != nullptr ? static_cast<Unit&>(*sequence_tests) : *family_sequence_tests;
}

StreamOutput<TestedEdge>& TessellationTests::to_pass_or_tessellate(std::size_t lane) const {
    if (collect_tests != nullptr)
        return collect_tests->to_pass_or_tessellate;
    return sequence_tests != nullptr ? sequence_tests->to_pass_or_tessellate
                                     : family_sequence_tests->to_pass_or_tessellate[lane];
}

std::vector<Unit*> TessellationTests::units() const {
    std::vector<Unit*> all = {&calculate_new_u, &tex_coord_test, &height_test, &normal_test, &view_test, &collector()};
    for (std::size_t k = 1; k < lanes_.size(); ++k)
        all.insert(all.end(), {&lanes_[k].calculate_new_u, &lanes_[k].tex_coord_test, &lanes_[k].view_test});
    all.insert(all.end(), normal_tests_.begin() + 1, normal_tests_.end());
    return all;
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
void TessellationTests::take_results(Collector& collector) {
    tex_coord_test.output.bind(collector.from_tex_coord_test);
    height_test.output.bind(collector.from_summed_height_test);
    normal_test.output.bind(collector.from_normal_test);
    view_test.output.bind(collector.from_view_test);
}

}  // namespace tessera
