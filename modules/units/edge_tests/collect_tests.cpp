#include "modules/units/edge_tests/collect_tests.h"

#include <algorithm>

#include "modules/units/edge_tests/test_results.h"

namespace tessera {

CollectTests::CollectTests(const sc_core::sc_module_name& name, const UnitContext& context)
    : CollectingUnit(name, context.clock), registers_(context.registers) {
    add_input(context, from_normal_test);
    add_input(context, from_tex_coord_test);
    add_input(context, from_summed_height_test);
    add_input(context, from_view_test);
    to_pass_or_tessellate.clocked_by(context, *this);
    const ItemWidths bits(context);
    area_.register_bits += context.timing().results_buffer * (bits.of<HeightResult>() + bits.of<NormalResult>() +
                                                              bits.of<TexCoordResult>() + bits.of<ViewResult>());
}

template <class Result>
void CollectTests::add_input(const UnitContext& context, StreamInput<Result>& input) {
    input.template register_b_transport<&CollectTests::b_transport<Result>>(*this);
    input.clocked_by(context.clock, *this, context.timing().results_buffer, context.timing().stalls);
    input.waits_for_all(empty_inputs_);
}

template <class Result>
void CollectTests::b_transport(Result& result, sc_core::sc_time& delay) {
    Decided& decided = decided_.find_or_open(result.tag.triangle);
    decided.edge.tag = result.tag;
    add_result(decided.edge, result);
    decided.latest = std::max(decided.latest, delay);
    if (++decided.tests < 4)
        return;
    delay = decided.latest;
    TestedEdge edge = decided.edge;
    decided_.close(result.tag.triangle);
    to_pass_or_tessellate.transport(edge, delay);
}

/// Adds a test's result to the edge that leaves.
template <class Result>
void CollectTests::take(StreamInput<Result>& input) {
    const PartTag& tag = input.front().tag;
    if (tag.triangle != leaving_.tag.triangle || tag.part != leaving_.tag.part)
        SC_REPORT_ERROR("tessera/collect_tests", "the tests' results belong to different edges");
    add_result(leaving_, input.front());
    input.pop();
}

void CollectTests::step() {
    const std::uint64_t cycle = now();
    for (;;) {
        if (leaves_) {
            if (!to_pass_or_tessellate.deliver(leaving_))
                break;
            leaves_ = false;
            activity_.item_out(cycle);
        }
        if (empty_inputs_ > 0)
            break;
        leaving_ = {};
        leaving_.tag = from_view_test.front().tag;
        take(from_normal_test);
        take(from_tex_coord_test);
        take(from_summed_height_test);
        take(from_view_test);
        leaves_ = true;
        activity_.item_in(cycle);
    }
    if (leaves_)
        activity_.set(cycle, State::blocked, to_pass_or_tessellate.consumer());
    else
        activity_.set(cycle, State::starved);
}

std::string CollectTests::describe_contents() const {
    const auto count = [](const auto& input, const char* test) {
        return input.empty() ? std::string{} : std::to_string(input.size()) + " from " + test + ", ";
    };
    std::string text = count(from_normal_test, "normal_test") + count(from_tex_coord_test, "tex_coord_test") +
                       count(from_summed_height_test, "summed_height_test") + count(from_view_test, "view_test");
    if (leaves_)
        text += "1 edge that Pass or Tessellate does not accept, ";
    return text.empty() ? text : text.substr(0, text.size() - 2);
}

/// Shows the edge that left last.
void CollectTests::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.input(from_normal_test, "from_normal_test");
    signals.input(from_tex_coord_test, "from_tex_coord_test");
    signals.input(from_summed_height_test, "from_summed_height_test");
    signals.input(from_view_test, "from_view_test");
    if (signals.when(signals.changed("collected", activity_.items_in()) && (leaves_ || signals.running())))
        show_tested_edge(signals, leaving_, registers_.tests);
    signals.pulse("edge", activity_.items_in());
}

}  // namespace tessera
