#include "modules/units/family/pass_or_tessellate.h"

#include <string>

#include "modules/datapath/edge_tests.h"
#include "modules/stage/signals.h"

namespace tessera {

FamilyPassOrTessellate::FamilyPassOrTessellate(const sc_core::sc_module_name& name, const UnitContext& context)
    : DecidingUnit(name, context),
      from_tessellation_tests("from_tessellation_tests", context.design.edge_lanes),
      places_(timing_.buffer),
      lit_(timing_),
      queued_(timing_) {
    const StallParameters& stalls = context.timing().stalls;
    from_tessellation.register_b_transport<&FamilyPassOrTessellate::b_transport_from_tessellation>(*this);
    from_tessellation.clocked_by(clock_, *this, 1, stalls);
    for (StreamInput<TestedEdge>& input : from_tessellation_tests) {
        input.register_b_transport<&FamilyPassOrTessellate::b_transport_from_tests>(*this);
        input.clocked_by(clock_, *this, 1, stalls);
    }
    to_triangle_queue.clocked_by(context, *this);
    const ItemWidths bits(context);
    constexpr std::uint64_t most_edges = 9;
    area_.register_bits += bits.of<Family>() + context.design.edge_lanes * bits.of<TestedEdge>() +
                           timing_.buffer * (bits.of<Family>() + most_edges * bits.of<TestedEdge>()) +
                           lit_.capacity() * bits.of<TriangleToLight>() +
                           queued_.capacity() * bits.of<datapath::Triangle>();
}

void FamilyPassOrTessellate::end_of_elaboration() {
    for (StreamInput<TestedEdge>& input : from_tessellation_tests)
        tests_.push_back(module_behind(input.get_base_port().get_interface()));
}

void FamilyPassOrTessellate::open(const Family& family) {
    Place& place = places_.open(family.tag);
    place.family = family;
    place.indices = datapath::triangulate(family.triangle.split, family.second_diagonal);
    place.edges = datapath::family_edges(place.indices, datapath::open_edges(family.untested, family.triangle.uncut));
    place.left = parts_of(place.edges);
    place.latest = sc_core::SC_ZERO_TIME;
}

void FamilyPassOrTessellate::take(Place& place, const TestedEdge& edge) {
    if ((place.left & edge.tag.bit()) == 0)
        SC_REPORT_ERROR("tessera/pass_or_tessellate", "an edge of a family arrived twice");
    place.left = static_cast<Parts>(place.left & ~edge.tag.bit());
    place.found[edge.tag.part - first_edge_part] = edge.found;
}

void FamilyPassOrTessellate::b_transport_from_tessellation(Family& family, sc_core::sc_time& delay) {
    open(family);
    finish_if_complete(*places_.find(family.tag), delay);
}

void FamilyPassOrTessellate::b_transport_from_tests(TestedEdge& edge, sc_core::sc_time& delay) {
    Place* place = places_.find(edge.tag.triangle);
    if (place == nullptr)
        SC_REPORT_ERROR("tessera/pass_or_tessellate", "an edge arrived for a family that has not arrived");
    take(*place, edge);
    finish_if_complete(*place, delay);
}

void FamilyPassOrTessellate::finish_if_complete(Place& waiting, sc_core::sc_time& delay) {
    waiting.latest = std::max(waiting.latest, delay);
    if (waiting.left != 0)
        return;
    decide(waiting);
    delay = waiting.latest + latency_;
    const Place place = waiting;
    places_.close(place.family.tag);
    for (int c = 0; c < place.indices.count; ++c) {
        const Child& child = place.children[static_cast<std::size_t>(c)];
        if (child.way == Way::tessellation) {
            datapath::Triangle triangle = child.triangle;
            to_triangle_queue.transport(triangle, delay);
        } else if (child.way == Way::lighting) {
            TriangleToLight triangle = to_light(place.family.origin, child.triangle);
            to_lighting.transport(triangle, delay);
        }
    }
}

/// Decides all children of a family whose edges have arrived.
void FamilyPassOrTessellate::decide(Place& place) {
    last_ = {place.family.origin, static_cast<unsigned>(place.indices.count), 0};
    unsigned told = 0;
    for (std::size_t c = 0; c < last_.children; ++c) {
        decide_child(place, c, told);
        const bool splits = place.children[c].way == Way::tessellation;
        last_.split |= splits ? 1u << c : 0u;
        ++(splits ? queued_children_ : lit_children_);
    }
    ++families_decided_;
    clock_.progress();
}

/// told: bit k is set if edge k has been reported with another child.
void FamilyPassOrTessellate::decide_child(Place& place, std::size_t c, unsigned& told) {
    const Family& family = place.family;
    const auto& corners = place.indices.children[c];
    datapath::TrianglePass pass;
    datapath::Triangle& triangle = pass.triangle;
    triangle = family.triangle;
    triangle.split = triangle.uncut = 0;
    for (std::size_t k = 0; k < 3; ++k)
        triangle.vertices[k] = family.vertices[corners[k]];
    Child& child = place.children[c];
    pass.number = static_cast<std::uint32_t>(counts_.passes);
    pass.told = datapath::Told::tests;
    pass.tested = true;
    pass.new_vertices = family.untested ? vertex_parts : std::uint8_t{0};
    for (std::size_t k = 0; k < 3; ++k) {
        const unsigned edge = place.edges.of_child[c][k];
        if (edge == datapath::FamilyEdges::whole) {
            triangle.final_edges = static_cast<std::uint8_t>(triangle.final_edges | 1u << k);
            continue;
        }
        pass.edges[k] = place.found[edge];
        pass.shared = static_cast<std::uint8_t>(pass.shared | (told >> edge & 1u) << k);
        told |= 1u << edge;
    }
    decide_edges(pass);
    decided.write(pass);
    if (pass.split == 0) {
        child.way = finish(triangle);
        child.triangle = triangle;
        return;
    }
    child.way = Way::tessellation;
    triangle.final_edges = 0;
    triangle.split = pass.split;
    triangle.parent = pass.number;
    triangle.split_by = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const datapath::EdgeTests& found = pass.edges[k];
        if ((pass.split >> k & 1u) == 0) {
            triangle.uncut = static_cast<std::uint8_t>(triangle.uncut | datapath::split_decision(found.tests) << k);
            continue;
        }
        triangle.split_by = static_cast<std::uint8_t>(triangle.split_by | (found.tests & datapath::requesting_tests));
        triangle.midpoints[k] = {found.normal, found.tangent, found.displaced_normal};
    }
    child.triangle = triangle;
}

/// A family is accepted only if it has a place: its edges follow out of order and must not wait for a place.
bool FamilyPassOrTessellate::take_inputs(std::uint64_t cycle) {
    bool taken = false;
    if (front_has_place_ && !places_.full()) {
        front_has_place_ = false;
        from_tessellation.pop();
    }
    while (!from_tessellation.empty() && !front_has_place_) {
        open(from_tessellation.front());
        activity_.item_in(cycle);
        most_incomplete_ = std::max(most_incomplete_, places_.size());
        taken = true;
        front_has_place_ = places_.full();
        if (!front_has_place_)
            from_tessellation.pop();
    }
    for (StreamInput<TestedEdge>& input : from_tessellation_tests) {
        for (; !input.empty(); input.pop()) {
            Place* place = places_.find(input.front().tag.triangle);
            if (place == nullptr)
                break;
            take(*place, input.front());
            taken = true;
        }
    }
    return taken;
}

/// The next child that leaves on an output; null if no decided child does.
FamilyPassOrTessellate::Child* FamilyPassOrTessellate::next(Next& from, bool whole) {
    for (; from.place < decided_; ++from.place, from.child = 0) {
        Place& place = places_.at(from.place);
        for (; from.child < place.indices.count; ++from.child) {
            Child& child = place.children[static_cast<std::size_t>(from.child)];
            if ((child.way != Way::tessellation) == whole)
                return &child;
        }
    }
    return nullptr;
}

bool FamilyPassOrTessellate::start_children(std::uint64_t cycle) {
    bool started = false;
    for (const Child* child = next(next_lit_, true); child != nullptr && lit_.may_start(cycle);
         child = next(next_lit_, true)) {
        lit_.start(cycle) = {to_light(places_.at(next_lit_.place).family.origin, child->triangle),
                             child->way == Way::dropped};
        ++next_lit_.child;
        started = true;
    }
    for (const Child* child = next(next_queued_, false); child != nullptr && queued_.may_start(cycle);
         child = next(next_queued_, false)) {
        queued_.start(cycle) = child->triangle;
        ++next_queued_.child;
        started = true;
    }
    return started;
}

/// Closes the places of families whose children have all left.
bool FamilyPassOrTessellate::close_places(std::uint64_t cycle) {
    bool closed = false;
    while (next_lit_.place > 0 && next_queued_.place > 0) {
        places_.close_oldest();
        activity_.item_out(cycle);
        --decided_;
        --next_lit_.place;
        --next_queued_.place;
        closed = true;
    }
    return closed;
}

void FamilyPassOrTessellate::step() {
    const std::uint64_t cycle = now();
    while (lit_.front_finished(cycle) && (lit_.front().culled || to_lighting.deliver(lit_.front().triangle)))
        lit_.pop();
    while (queued_.front_finished(cycle) && to_triangle_queue.deliver(queued_.front()))
        queued_.pop();
    for (bool changed = true; changed;) {
        changed = take_inputs(cycle);
        while (decided_ < places_.size() && places_.at(decided_).left == 0 && next_decision_ <= cycle) {
            decide(places_.at(decided_++));
            next_decision_ = cycle + timing_.interval;
            changed = true;
        }
        changed = start_children(cycle) || changed;
        changed = close_places(cycle) || changed;
    }
    if (!to_lighting.free())
        activity_.set(cycle, State::blocked, to_lighting.consumer());
    else if (!to_triangle_queue.free())
        activity_.set(cycle, State::blocked, to_triangle_queue.consumer());
    else if (!lit_.empty() || !queued_.empty() || decided_ > 0)
        activity_.set(cycle, State::busy);
    else
        activity_.set(cycle, State::starved, places_.empty() || tests_.size() > 1 ? nullptr : tests_.front());
    wake_at(lit_.next_finished(cycle));
    wake_at(queued_.next_finished(cycle));
    if (decided_ > 0) {
        wake_at(lit_.next_start(cycle));
        wake_at(queued_.next_start(cycle));
    }
    if (decided_ < places_.size() && next_decision_ > cycle)
        wake_at(next_decision_);
}

std::string FamilyPassOrTessellate::describe_contents() const {
    std::string text;
    if (!places_.empty()) {
        const Place& first = places_.oldest();
        text = count_of(places_.size(), "place") + " taken, the first by a family (" +
               std::to_string(first.family.origin.pass) + ") " +
               (first.left == 0 ? "that is complete" : "that waits for Tessellation Tests");
    }
    std::size_t edges = 0;
    for (const StreamInput<TestedEdge>& input : from_tessellation_tests)
        edges += input.size();
    text = listed(text, count_of(lit_.size() + queued_.size(), "decided triangle"), "; ");
    text = listed(text, from_tessellation.holds_back() ? "a family that waits for a place" : "", "; ");
    return listed(
        text, count_of(edges, "tested edge") + (edges > 0 ? " that arrived before its family had a place" : ""), "; ");
}

/// Shows the family decided last, and which of its children split.
void FamilyPassOrTessellate::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.input(from_tessellation, "from_tessellation");
    for (const StreamInput<TestedEdge>& input : from_tessellation_tests)
        signals.input(input, input.basename());
    signals.value("families", 16, places_.size());
    signals.pulse("decided", families_decided_);
    if (signals.when(signals.changed("shown", families_decided_) && !places_.empty())) {
        signals.value("triangle", 32, last_.origin.pass);
        signals.value("base", 32, last_.origin.base);
        signals.value("children", 3, last_.children);
        signals.value("split_children", 4, last_.split);
    }
    signals.value("finished", 32, counts_.finished);
}

}  // namespace tessera
