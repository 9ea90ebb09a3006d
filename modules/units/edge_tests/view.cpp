#include "modules/units/edge_tests/view.h"

#include <algorithm>

#include "modules/datapath/edge_tests.h"
#include "modules/stage/stage_steps.h"

namespace tessera {

ViewTest::ViewTest(const sc_core::sc_module_name& name, const UnitContext& context)
    : Stage(name, context, context.timing().view_test),
      registers_(context.registers),
      last_edge_(last_of(parts_for_tests(context.tests_unit, context.design.tests_units) & triangle_edge_parts)),
      corners_(std::size_t{context.timing().pass_or_tessellate.buffer} + 2) {
    takes_from(context, input);
    delivers_to(context, output);
    may_wait();
    if (context.design.work == Work::family)
        return;
    from_transform.emplace("from_transform");
    from_transform->clocked_by(context.clock, *this, 1, context.timing().stalls);
    from_transform->register_b_transport<&ViewTest::take_corner>(*this);
    const datapath::Formats& f = registers_.formats;
    const int screen = 2 * f.screen.bits + (f.distances ? 2 : 1) * f.view_distance.bits + 1;
    const auto corners = static_cast<unsigned>(3 + 3 * screen + tag_bits(context.design));
    area_.register_bits += ItemWidths(context).of<ScreenCorner>() + corners_.places() * corners;
}

void ViewTest::end_of_elaboration() {
    if (from_transform)
        transform_ = module_behind(from_transform->get_base_port().get_interface());
}

void ViewTest::take_corner(ScreenCorner& corner, sc_core::sc_time& when) {
    Corners& corners = corners_.find_or_open(corner.tag.triangle);
    corners.come |= corner.tag.bit();
    corners.screen[corner.tag.index()] = corner.screen;
    corners.since = std::max(corners.since, when);
}

void ViewTest::step() {
    sc_core::sc_time now;
    for (; from_transform && !from_transform->empty(); from_transform->pop())
        take_corner(from_transform->front(), now);
    Stage::step();
}

bool ViewTest::may_start(const ViewOperands& edge) const {
    if (edge.new_vertices == 0)
        return true;
    const Corners* corners = corners_.find(edge.tag.triangle);
    return corners != nullptr && corners->come == edge.new_vertices;
}

sc_core::sc_time ViewTest::may_start_after(const ViewOperands& edge) const {
    return edge.new_vertices == 0 ? sc_core::SC_ZERO_TIME : corners_.find(edge.tag.triangle)->since;
}

ViewResult ViewTest::process(const ViewOperands& edge, const Entries&) {
    ends_ = {edge.screen_i, edge.screen_j};
    if (edge.new_vertices != 0) {
        const Corners& corners = *corners_.find(edge.tag.triangle);
        const unsigned i = edge.tag.index();
        const unsigned j = (i + 1) % 3;
        if ((corners.come >> i & 1u) != 0)
            ends_.i = corners.screen[i];
        if ((corners.come >> j & 1u) != 0)
            ends_.j = corners.screen[j];
        if (edge.tag.bit() == last_edge_)
            corners_.close(edge.tag.triangle);
    }
    return {edge.tag, !registers_.tests.view_test || view_test(ends_.i, ends_.j, registers_.tests),
            datapath::edge_in_view(ends_.i, ends_.j)};
}

void ViewTest::trace_signals(Signals& signals) const {
    Stage::trace_signals(signals);
    if (from_transform)
        signals.input(*from_transform, "from_transform");
    signals.value("threshold", 33, registers_.tests.view_threshold);
}

/// An edge with an end on or behind the near plane has no length on the screen and shows 0.
void ViewTest::trace_processed(Signals& signals, const ViewOperands&, const ViewResult&) const {
    signals.screen("screen_i", ends_.i);
    signals.screen("screen_j", ends_.j);
    signals.value("length", 33, ends_.i.in_front && ends_.j.in_front ? screen_length(ends_.i, ends_.j) : 0);
}

}  // namespace tessera
