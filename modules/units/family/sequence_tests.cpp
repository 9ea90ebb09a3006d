#include "modules/units/family/sequence_tests.h"

#include "modules/units/edge_tests/test_results.h"

namespace tessera {
namespace {

bool same_part(const PartTag& a, const PartTag& b) {
    return a.triangle == b.triangle && a.part == b.part;
}

}  // namespace

FamilySequenceTests::FamilySequenceTests(const sc_core::sc_module_name& name, const UnitContext& context)
    : SequencingUnit(name, context),
      normal_operands("normal_operands", context.design.edge_lanes),
      height_operands("height_operands", context.design.edge_lanes),
      from_tex_coord_test("from_tex_coord_test", context.design.edge_lanes),
      from_view_test("from_view_test", context.design.edge_lanes),
      to_pass_or_tessellate("to_pass_or_tessellate", context.design.edge_lanes),
      to_normal_test("to_normal_test", context.design.normal_tests),
      from_normal_test("from_normal_test", context.design.normal_tests),
      lanes_(context.design.edge_lanes),
      places_(context.timing().edges_in_sequence),
      for_normal_(places_),
      for_height_(places_),
      normals_(context.design.normal_tests),
      in_height_(places_),
      leaving_(places_) {
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        add_input(context, normal_operands[lane]);
        add_input(context, height_operands[lane]);
        add_input(context, from_tex_coord_test[lane]);
        add_input(context, from_view_test[lane]);
        to_pass_or_tessellate[lane].clocked_by(context, *this);
        // An edge is taken when all four have arrived.
        normal_operands[lane].waits_for_all(lanes_[lane].empty_inputs);
        height_operands[lane].waits_for_all(lanes_[lane].empty_inputs);
        from_tex_coord_test[lane].waits_for_all(lanes_[lane].empty_inputs);
        from_view_test[lane].waits_for_all(lanes_[lane].empty_inputs);
    }
    for (std::size_t k = 0; k < normals_.size(); ++k) {
        normals_[k].in_test = Ring<Edge>(places_);
        add_input(context, from_normal_test[k]);
        to_normal_test[k].clocked_by(context, *this);
    }
}

/// The edges that wait for a test.
Ring<FamilySequenceTests::Edge>& FamilySequenceTests::waiting_for(Next next) {
    return next == Next::normal_test ? for_normal_ : for_height_;
}

/// Moves an edge to where it waits next.
void FamilySequenceTests::decided(const Edge& edge, Next next) {
    if (next == Next::leave)
        leaving_.push(edge.tested);
    else
        waiting_for(next).push(edge);
}

/// Accepts an edge whose cheap tests have decided, one per cycle and lane.
bool FamilySequenceTests::take_edge(std::size_t lane, std::uint64_t cycle) {
    if (lanes_[lane].empty_inputs > 0 || taken_ == places_)
        return false;
    if (lanes_[lane].next_in > cycle) {
        wake_at(lanes_[lane].next_in);
        return false;
    }
    const NormalOperands& normal = normal_operands[lane].front();
    HeightOperands& height = height_operands[lane].front();
    height.ends = from_view_test[lane].front().ends;
    TestedEdge tested;
    tested.tag = normal.tag;
    add_result(tested, from_tex_coord_test[lane].front());
    add_result(tested, from_view_test[lane].front());
    for (const PartTag* tag : {&height.tag, &from_tex_coord_test[lane].front().tag, &from_view_test[lane].front().tag})
        if (!same_part(*tag, tested.tag))
            SC_REPORT_ERROR("tessera/sequence_tests", "the tests' results belong to different edges");
    const Next next = after_cheap_tests(tested, normal, height);
    if (next == Next::leave) {
        leaving_.push(tested);
    } else {
        Edge& edge = waiting_for(next).push();
        edge.tested = tested;
        edge.normal = normal;
        edge.height = height;
    }
    normal_operands[lane].pop();
    height_operands[lane].pop();
    from_tex_coord_test[lane].pop();
    from_view_test[lane].pop();
    activity_.item_in(cycle);
    ++taken_;
    lanes_[lane].next_in = cycle + 1;
    return true;
}

/// Each test returns its results in the order of its operands.
bool FamilySequenceTests::take_results() {
    bool taken = false;
    const auto take = [&](Ring<Edge>& in_test, auto& input, auto&& next) {
        for (; !input.empty(); input.pop()) {
            if (in_test.empty() || !same_part(in_test.front().tested.tag, input.front().tag))
                SC_REPORT_ERROR("tessera/sequence_tests", "a result for an edge that was not sent to the test");
            add_result(in_test.front().tested, input.front());
            decided(in_test.front(), next(in_test.front()));
            in_test.pop();
            taken = true;
        }
    };
    take(in_height_, from_summed_height_test, [&](const Edge& edge) { return after_height_test(edge.tested); });
    for (std::size_t k = 0; k < normals_.size(); ++k)
        take(normals_[k].in_test, from_normal_test[k], [&](const Edge& edge) { return after_normal_test(edge); });
    return taken;
}

/// Sends the oldest edge to the next free Normal Test.
bool FamilySequenceTests::send_to_normal_test() {
    if (for_normal_.empty())
        return false;
    std::size_t k = normal_turn_;
    for (std::size_t tried = 1; !to_normal_test[k].free() && tried < normals_.size(); ++tried)
        k = (k + 1) % normals_.size();
    if (!to_normal_test[k].free())
        return false;
    Normal& normal = normals_[k];
    normal.offered = for_normal_.front().normal;
    normal.in_test.push(for_normal_.front());
    for_normal_.pop();
    to_normal_test[k].send(normal.offered);
    normal_turn_ = (k + 1) % normals_.size();
    return true;
}

bool FamilySequenceTests::send_to_summed_height_test() {
    if (for_height_.empty() || !to_summed_height_test.free())
        return false;
    in_height_.push(for_height_.front());
    height_offered_ = for_height_.front().height;
    for_height_.pop();
    to_summed_height_test.send(height_offered_);
    return true;
}

/// Sends decided edges on, one per cycle and lane.
bool FamilySequenceTests::leave(std::uint64_t cycle) {
    bool left = false;
    for (std::size_t k = 0; k < lanes_.size() && !leaving_.empty(); ++k) {
        Lane& lane = lanes_[k];
        if (lane.next_out > cycle) {
            wake_at(lane.next_out);
            continue;
        }
        if (!to_pass_or_tessellate[k].free())
            continue;
        lane.leaving = leaving_.front();
        leaving_.pop();
        lane.next_out = cycle + 1;
        last_lane_ = k;
        --taken_;
        to_pass_or_tessellate[k].send(lane.leaving);
        activity_.item_out(cycle);
        left = true;
    }
    return left;
}

void FamilySequenceTests::step() {
    const std::uint64_t cycle = now();
    for (bool changed = true; changed;) {
        changed = take_results();
        changed = leave(cycle) || changed;
        for (std::size_t lane = 0; lane < lanes_.size(); ++lane)
            changed = take_edge(lane, cycle) || changed;
        changed = send_to_normal_test() || changed;
        changed = send_to_summed_height_test() || changed;
    }
    if (!leaving_.empty())
        activity_.set(cycle, lanes_[0].next_out > cycle ? State::busy : State::blocked,
                      lanes_[0].next_out > cycle ? nullptr : to_pass_or_tessellate[0].consumer());
    else if (!for_normal_.empty())
        activity_.set(cycle, State::blocked, to_normal_test[0].consumer());
    else if (!for_height_.empty())
        activity_.set(cycle, State::blocked, to_summed_height_test.consumer());
    else
        activity_.set(cycle, State::starved);
}

std::string FamilySequenceTests::describe_contents() const {
    std::string text;
    const auto count = [&](std::size_t number, const char* what, const char* where) {
        text = listed(text, number == 0 ? "" : count_of(number, what) + where);
    };
    count(for_normal_.size(), "edge", " for the Normal Test");
    for (const Normal& normal : normals_)
        count(normal.in_test.size(), "edge", " in the Normal Test");
    count(for_height_.size(), "edge", " for the Summed Height Test");
    count(in_height_.size(), "edge", " in the Summed Height Test");
    count(leaving_.size(), "decided edge", "");
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        count(to_pass_or_tessellate[lane].free() ? 0 : 1, "edge", " that Pass or Tessellate does not accept");
        count(normal_operands[lane].size(), "edge", " from calculate_new_u");
        count(height_operands[lane].size(), "edge", " from calculate_new_u for summed_height_test");
        count(from_tex_coord_test[lane].size(), "result", " from tex_coord_test");
        count(from_view_test[lane].size(), "result", " from view_test");
    }
    return text;
}

/// Shows the edge that left last.
void FamilySequenceTests::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    const auto inputs = [&](const auto& all) {
        for (const auto& input : all)
            signals.input(input, input.basename());
    };
    inputs(normal_operands);
    inputs(height_operands);
    inputs(from_tex_coord_test);
    inputs(from_view_test);
    inputs(from_normal_test);
    signals.input(from_summed_height_test, "from_summed_height_test");
    signals.value("places_taken", 16, taken_);
    signals.value("for_normal_test", 16, for_normal_.size());
    signals.value("for_summed_height_test", 16, for_height_.size());
    if (signals.when(signals.changed("collected", activity_.items_out())))
        show_tested_edge(signals, lanes_[last_lane_].leaving, registers_.tests);
    signals.value("edges_out", 32, activity_.items_out());
}

}  // namespace tessera
