#include "modules/units/tessellation_tests/view_test.h"

#include <algorithm>

#include "modules/datapath/edge_tests.h"
#include "modules/unit/signals.h"

namespace tessera {

ViewTest::ViewTest(const sc_core::sc_module_name& name, Clock& clock, const datapath::Registers& registers,
                   const Timing& timing, Parts takes)
    : Stage(name, clock, timing.view_test),
      registers_(registers),
      last_edge_(last_of(takes)),
      corners_(std::size_t{timing.pass_or_tessellate.buffer} + 2) {
    takes_from(input, timing.stalls);
    delivers_to(output);
    from_transform.clocked_by(clock, *this, 1, timing.stalls);
    from_transform.serve<&ViewTest::take_corner>(*this);
}

void ViewTest::end_of_elaboration() {
    transform_ = module_behind(from_transform.get_base_port().get_interface());
}

void ViewTest::take_corner(Work& corner, sc_core::sc_time& when) {
    Corners& corners = corners_.find_or_open(corner.tag());
    corners.on_screen |= corner.parts;
    corners.since = std::max(corners.since, when);
}

void ViewTest::step() {
    sc_core::sc_time now;
    for (; !from_transform.empty(); from_transform.pop())
        take_corner(from_transform.front(), now);
    Stage::step();
}

bool ViewTest::may_start(const Work& edge) const {
    if (edge.pass->new_vertices == 0)
        return true;
    const Corners* corners = corners_.find(edge.tag());
    return corners != nullptr && corners->on_screen == edge.pass->new_vertices;
}

sc_core::sc_time ViewTest::may_start_after(const Work& edge) const {
    return edge.pass->new_vertices == 0 ? sc_core::SC_ZERO_TIME : corners_.find(edge.tag())->since;
}

Work ViewTest::process(const Work& part, const Entries&) {
    const int k = static_cast<int>(part.index());
    if (!registers_.tests.view_test ||
        view_test(part.pass->edge_begin(k).screen, part.pass->edge_end(k).screen, registers_.tests))
        part.pass->edges[part.index()].tests |= datapath::view_bit;
    if (part.pass->new_vertices != 0 && part.parts == last_edge_)
        corners_.close(part.tag());
    return part;
}

void ViewTest::show(Signals& signals) const {
    Stage::show(signals);
    signals.input(from_transform, "from_transform");
    signals.value("threshold", 33, registers_.tests.view_threshold);
}

/// An edge that has no length on the screen, for an end is not in front of the near plane, shows 0.
void ViewTest::trace_processed(Signals& signals, const Work& work, const Work&) const {
    const datapath::ScreenPosition& i = Signals::begin_of(work).screen;
    const datapath::ScreenPosition& j = Signals::end_of(work).screen;
    signals.screen("screen_i_x", "screen_i_y", i);
    signals.screen("screen_j_x", "screen_j_y", j);
    signals.value("length", 33, i.in_front && j.in_front ? screen_length(i, j) : 0);
    const unsigned tests = Signals::pass_of(work).edges[work.index()].tests;
    signals.flag("view", (tests & datapath::view_bit) != 0);
}

}  // namespace tessera
