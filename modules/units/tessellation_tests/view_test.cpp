#include "modules/units/tessellation_tests/view_test.h"

#include <algorithm>

#include "modules/datapath/edge_tests.h"
#include "modules/unit/signals.h"

namespace tessera {

ViewTest::ViewTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                   const Timing& timing, unsigned number)
    : WorkStage(name, clock, timing.view_test), registers_(registers), number_(number) {
    takes_from(input, timing.stalls);
    delivers_to(output);
    from_transform.clocked_by(clock, *this, 1, timing.stalls);
    input.serve<&ViewTest::b_transport>(*this);
    from_transform.serve<&ViewTest::b_transport_from_transform>(*this);
}

void ViewTest::end_of_elaboration() {
    transform_ = module_behind(from_transform.get_base_port().get_interface());
}

void ViewTest::process(const Work& work) {
    Pass& pass = *work.pass;
    for_each_of_three(work.parts, first_edge_part, [&](unsigned k) {
        const int edge = static_cast<int>(k);
        if (!registers_.tests.view_test ||
            view_test(pass.edge_begin(edge).screen, pass.edge_end(edge).screen, registers_.tests))
            pass.edges[k].tests |= datapath::view_bit;
    });
}

void ViewTest::b_transport_from_transform(Work& work, sc_core::sc_time& delay) {
    on_screen_ = work.pass;
    on_screen_delay_ = delay;
}

void ViewTest::b_transport(Work& work, sc_core::sc_time& delay) {
    if ((work.parts & vertex_parts) != 0) {
        if (on_screen_ != work.pass)
            SC_REPORT_ERROR("tessera/view_test", "a base triangle's edges came before its screen positions");
        on_screen_ = nullptr;
        delay = std::max(delay, on_screen_delay_);
    }
    process(work);
    delay += clock_.period() * timing_.latency;
    output->b_transport(work, delay);
}

bool ViewTest::may_begin(const Work& work) {
    return work.pass->corners_on_screen[number_] == work.pass->new_vertices;
}

void ViewTest::step() {
    from_transform.admit();
    while (!from_transform.empty()) {
        const Work& corner = from_transform.front();
        std::uint8_t& come = corner.pass->corners_on_screen[number_];
        come = static_cast<std::uint8_t>(come | (corner.parts & vertex_parts));
        from_transform.pop();
    }
    WorkStage::step();
}

void ViewTest::show(Signals& signals) const {
    WorkStage::show(signals);
    signals.input(from_transform, "from_transform");
    signals.value("threshold", 33, registers_.tests.view_threshold);
}

/// An edge that has no length on the screen, for an end is not in front of the near plane, shows 0.
void ViewTest::trace_item(Signals& signals, const Work& work) const {
    const datapath::ScreenPosition& i = Signals::begin_of(work).screen;
    const datapath::ScreenPosition& j = Signals::end_of(work).screen;
    signals.screen("screen_i_x", "screen_i_y", i);
    signals.screen("screen_j_x", "screen_j_y", j);
    signals.value("length", 33, i.in_front && j.in_front ? screen_length(i, j) : 0);
    const unsigned tests = Signals::pass_of(work).edges[Signals::index_of(work)].tests;
    signals.flag("view", (tests & datapath::view_bit) != 0);
}

}  // namespace tessera
