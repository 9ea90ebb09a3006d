#include "modules/units/tessellation_tests/collect_tests.h"

#include <algorithm>

#include "modules/datapath/edge_tests.h"
#include "modules/unit/signals.h"

namespace tessera {

CollectTests::CollectTests(const sc_core::sc_module_name& name, Clock& clock,
                           const datapath::Registers& registers, const Timing& timing)
    : Unit(name, clock), registers_(registers) {
    for (StreamInput<Work>* input : inputs()) {
        input->serve<&CollectTests::b_transport>(*this);
        input->clocked_by(clock, *this, timing.results_buffer, timing.stalls);
        input->waits_for_all(empty_inputs_);
    }
    to_pass_or_tessellate.clocked_by(clock, *this);
}

void CollectTests::b_transport(Work& work, sc_core::sc_time& delay) {
    Decided& decided = decided_.find_or_open(work.tag());
    decided.latest = std::max(decided.latest, delay);
    if (++decided.tests < 4)
        return;
    delay = decided.latest;
    decided_.close(work.tag());
    to_pass_or_tessellate->b_transport(work, delay);
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
        leaving_ = from_view_test.front();
        for (StreamInput<Work>* input : inputs()) {
            if (input->front().pass != leaving_.pass || input->front().parts != leaving_.parts)
                SC_REPORT_ERROR("tessera/collect_tests", "the tests decided different edges");
            input->pop();
        }
        leaves_ = true;
        activity_.item_in(cycle);
    }
    if (leaves_)
        activity_.set(cycle, State::blocked, to_pass_or_tessellate.consumer());
    else
        activity_.set(cycle, State::starved);
}

std::string CollectTests::holds() const {
    const auto count = [](const StreamInput<Work>& input, const char* test) {
        return input.empty() ? std::string{} : std::to_string(input.size()) + " from " + test + ", ";
    };
    std::string text = count(from_normal_test, "normal_test") + count(from_tex_coord_test, "tex_coord_test") +
                       count(from_summed_height_test, "summed_height_test") +
                       count(from_view_test, "view_test");
    if (leaves_)
        text += "1 edge that Pass or Tessellate does not take, ";
    return text.empty() ? text : text.substr(0, text.size() - 2);
}

/// Shows the edge that left last.
void CollectTests::show(Signals& signals) const {
    Unit::show(signals);
    signals.input(from_normal_test, "from_normal_test");
    signals.input(from_tex_coord_test, "from_tex_coord_test");
    signals.input(from_summed_height_test, "from_summed_height_test");
    signals.input(from_view_test, "from_view_test");
    signals.group(signals.changed(activity_.items_in()) && (leaves_ || signals.running()), [&] {
        const unsigned tests = Signals::pass_of(leaving_).edges[leaving_.index()].tests;
        signals.work(leaving_);
        signals.flag("normal", (tests & datapath::normal_bit) != 0);
        signals.flag("summed_height", (tests & datapath::summed_height_bit) != 0);
        signals.flag("view", (tests & datapath::view_bit) != 0);
        signals.flag("tex_coord", (tests & datapath::tex_coord_bit) != 0);
        signals.flag("generation", (tests & datapath::generation_bit) != 0);
        if (registers_.tests.highlight_test)
            signals.flag("highlight", (tests & datapath::highlight_bit) != 0);
        signals.flag("split", datapath::split_decision(static_cast<std::uint8_t>(tests)));
    });
    signals.pulse("edge", activity_.items_in());
}

}  // namespace tessera
