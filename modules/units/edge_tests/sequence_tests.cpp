#include "modules/units/edge_tests/sequence_tests.h"

#include "modules/units/edge_tests/test_results.h"

namespace tessera {

SequenceTests::SequenceTests(const sc_core::sc_module_name& name, const UnitContext& context)
    : SequencingUnit(name, context), edges_(context.timing().edges_in_sequence) {
    add_input(context, normal_operands);
    add_input(context, height_operands);
    add_input(context, from_tex_coord_test);
    add_input(context, from_view_test);
    add_input(context, from_normal_test);
    to_normal_test.clocked_by(context, *this);
    to_pass_or_tessellate.clocked_by(context, *this);
}

/// Returns null if there is no edge.
SequenceTests::Edge* SequenceTests::first(Next next) {
    for (std::size_t k = 0; k < edges_.size(); ++k)
        if (edges_.at(k).next == next)
            return &edges_.at(k);
    return nullptr;
}

bool SequenceTests::take_vertex(std::uint64_t cycle) {
    if (vertex_waits_ || normal_operands.empty() || !normal_operands.front().tag.is_vertex() ||
        first(Next::normal_test) != nullptr || !may_take(cycle))
        return false;
    vertex_ = normal_operands.front();
    normal_operands.pop();
    vertex_waits_ = true;
    return true;
}

/// One edge or vertex per cycle.
bool SequenceTests::may_take(std::uint64_t cycle) {
    if (next_take_ > cycle) {
        wake_at(next_take_);
        return false;
    }
    next_take_ = cycle + 1;
    return true;
}

/// Accepts an edge whose cheap tests have decided.
bool SequenceTests::take_edge(std::uint64_t cycle) {
    if (edges_.full() || vertex_waits_ || normal_operands.empty() || normal_operands.front().tag.is_vertex() ||
        height_operands.empty() || from_tex_coord_test.empty() || from_view_test.empty() || !may_take(cycle))
        return false;
    Edge& edge = edges_.push();
    edge.normal = normal_operands.front();
    edge.height = height_operands.front();
    edge.height.ends = from_view_test.front().ends;
    edge.tested = {};
    edge.tested.tag = edge.normal.tag;
    add_result(edge.tested, from_tex_coord_test.front());
    add_result(edge.tested, from_view_test.front());
    for (const PartTag& tag : {edge.height.tag, from_tex_coord_test.front().tag, from_view_test.front().tag})
        if (tag.triangle != edge.tested.tag.triangle || tag.part != edge.tested.tag.part)
            SC_REPORT_ERROR("tessera/sequence_tests", "the tests' results belong to different edges");
    edge.next = after_cheap_tests(edge.tested, edge.normal, edge.height);
    normal_operands.pop();
    height_operands.pop();
    from_tex_coord_test.pop();
    from_view_test.pop();
    activity_.item_in(cycle);
    return true;
}

/// Sends a vertex and edges on to the tests they need, the oldest first. What is on offer stays on offer.
bool SequenceTests::send_on() {
    bool sent = false;
    if (vertex_waits_ && to_normal_test.deliver(vertex_)) {
        vertex_waits_ = false;
        sent = true;
    }
    const auto send = [&](Edge*& offered, Next waiting, Next asked, auto&& deliver) {
        for (;;) {
            if (offered == nullptr)
                offered = first(waiting);
            if (offered == nullptr || !deliver(*offered))
                return;
            offered->next = asked;
            offered = nullptr;
            sent = true;
        }
    };
    if (!vertex_waits_)
        send(to_normal_, Next::normal_test, Next::normal_result,
             [&](Edge& edge) { return to_normal_test.deliver(edge.normal); });
    send(to_height_, Next::summed_height_test, Next::summed_height_result,
         [&](Edge& edge) { return to_summed_height_test.deliver(edge.height); });
    return sent;
}

/// Returns null if no such edge waits for this result.
SequenceTests::Edge* SequenceTests::in_test(const PartTag& tag, Next expected) {
    for (std::size_t k = 0; k < edges_.size(); ++k) {
        Edge& edge = edges_.at(k);
        if (edge.next == expected && edge.tested.tag.triangle == tag.triangle && edge.tested.tag.part == tag.part)
            return &edge;
    }
    return nullptr;
}

/// Edges may overtake one another between two tests, so the tag identifies the edge of a result.
template <class Result>
bool SequenceTests::take_result(StreamInput<Result>& input, Next expected) {
    if (input.empty())
        return false;
    Edge* const edge = in_test(input.front().tag, expected);
    if (edge == nullptr)
        SC_REPORT_ERROR("tessera/sequence_tests", "a result for an edge that was not sent to the test");
    add_result(edge->tested, input.front());
    edge->next = expected == Next::normal_result ? after_normal_test(*edge) : after_height_test(edge->tested);
    input.pop();
    return true;
}

bool SequenceTests::leave(std::uint64_t cycle) {
    if (edges_.empty() || edges_.front().next != Next::leave)
        return false;
    if (next_leave_ > cycle) {
        wake_at(next_leave_);
        return false;
    }
    if (!to_pass_or_tessellate.deliver(edges_.front().tested))
        return false;
    next_leave_ = cycle + 1;
    left_ = edges_.front().tested;
    edges_.pop();
    activity_.item_out(cycle);
    return true;
}

void SequenceTests::step() {
    const std::uint64_t cycle = now();
    for (bool changed = true; changed;) {
        changed = take_result(from_summed_height_test, Next::summed_height_result);
        changed = take_result(from_normal_test, Next::normal_result) || changed;
        changed = leave(cycle) || changed;
        changed = take_vertex(cycle) || changed;
        changed = take_edge(cycle) || changed;
        changed = send_on() || changed;
    }
    const Next next = edges_.empty() ? Next::leave : edges_.front().next;
    if (!edges_.empty() && next == Next::leave && next_leave_ > cycle)
        activity_.set(cycle, State::busy);
    else if (!edges_.empty() && next == Next::leave)
        activity_.set(cycle, State::blocked, to_pass_or_tessellate.consumer());
    else if (next == Next::summed_height_test)
        activity_.set(cycle, State::blocked, to_summed_height_test.consumer());
    else if (next == Next::normal_test || vertex_waits_)
        activity_.set(cycle, State::blocked, to_normal_test.consumer());
    else if (next == Next::summed_height_result)
        activity_.set(cycle, State::starved, to_summed_height_test.consumer());
    else if (next == Next::normal_result)
        activity_.set(cycle, State::starved, to_normal_test.consumer());
    else
        activity_.set(cycle, State::starved);
}

std::string SequenceTests::describe_contents() const {
    std::string text = count_of(edges_.size(), "edge");
    if (!edges_.empty()) {
        constexpr const char* waits_for[] = {"the Normal Test to take it", "the Normal Test",
                                             "the Summed Height Test to take it", "the Summed Height Test",
                                             "Pass or Tessellate to take it"};
        text += std::string(", the oldest waits for ") + waits_for[static_cast<std::size_t>(edges_.front().next)];
    }
    const auto count = [&](const auto& input, const char* what) {
        text = listed(text, input.empty() ? "" : std::to_string(input.size()) + " " + what);
    };
    if (vertex_waits_)
        text = listed(text, "a vertex that the Normal Test does not accept");
    count(normal_operands, "from calculate_new_u");
    count(height_operands, "from calculate_new_u for summed_height_test");
    count(from_tex_coord_test, "from tex_coord_test");
    count(from_view_test, "from view_test");
    count(from_normal_test, "from normal_test");
    count(from_summed_height_test, "from summed_height_test");
    return text;
}

/// Shows the edge that left last.
void SequenceTests::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.input(normal_operands, "normal_operands");
    signals.input(height_operands, "height_operands");
    signals.input(from_tex_coord_test, "from_tex_coord_test");
    signals.input(from_view_test, "from_view_test");
    signals.input(from_normal_test, "from_normal_test");
    signals.input(from_summed_height_test, "from_summed_height_test");
    signals.value("edges", 16, edges_.size());
    if (signals.when(signals.changed("collected", activity_.items_out())))
        show_tested_edge(signals, left_, registers_.tests);
    signals.pulse("edge", activity_.items_out());
}

}  // namespace tessera
