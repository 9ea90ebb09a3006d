#include "modules/units/pass_or_tessellate.h"

#include <algorithm>
#include <string>

#include "modules/datapath/edge_tests.h"
#include "modules/stage/signals.h"

namespace tessera {

PassOrTessellate::PassOrTessellate(const sc_core::sc_module_name& name, const UnitContext& context)
    : DecidingUnit(name, context),
      from_tessellation_tests("from_tessellation_tests", context.design.tests_units),
      incomplete_(timing_.buffer),
      pipeline_(timing_) {
    const StallParameters& stalls = context.timing().stalls;
    from_get_triangle.register_b_transport<&PassOrTessellate::b_transport_from_get_triangle>(*this);
    from_get_triangle.clocked_by(clock_, *this, triangles_ahead_of_parts(context.design), stalls);
    from_transform.register_b_transport<&PassOrTessellate::b_transport_from_transform>(*this);
    from_transform.clocked_by(clock_, *this, 1, stalls);
    for (StreamInput<TestedEdge>& input : from_tessellation_tests) {
        input.register_b_transport<&PassOrTessellate::b_transport_from_tests>(*this);
        input.clocked_by(clock_, *this, timing_.buffer * 3 / context.design.tests_units, stalls);
    }
    to_tessellation.clocked_by(context, *this);
    const ItemWidths bits(context);
    area_.register_bits +=
        from_get_triangle.depth() * bits.of<TakenTriangle>() + bits.of<ScreenPoint>() +
        std::uint64_t{3} * timing_.buffer * bits.of<TestedEdge>() +
        (timing_.buffer + pipeline_.capacity()) * (static_cast<unsigned>(bits.tag) + bits.of<DecidedTriangle>());
}

void PassOrTessellate::end_of_elaboration() {
    transform_ = module_behind(from_transform.get_base_port().get_interface());
    for (StreamInput<TestedEdge>& input : from_tessellation_tests)
        tests_.push_back(module_behind(input.get_base_port().get_interface()));
}

void PassOrTessellate::open(const TakenTriangle& taken) {
    Incomplete& place = incomplete_.open(taken.tag);
    const Parts parts = parts_of(taken.triangle);
    datapath::TrianglePass& pass = place.triangle.pass;
    place.triangle.origin = taken.origin;
    pass.number = taken.origin.pass;
    pass.triangle = taken.triangle;
    pass.new_vertices = static_cast<std::uint8_t>(parts & vertex_parts);
    pass.new_normals = static_cast<std::uint8_t>((parts & normal_parts) >> first_normal_part);
    pass.tested = (parts & edge_parts) != 0;
    pass.split = 0;
    for (datapath::EdgeTests& edge : pass.edges)
        edge.tests = edge.evaluated = 0;
    place.geometry_left = parts;
    place.tests_left = static_cast<Parts>(parts & edge_parts);
    place.latest = sc_core::SC_ZERO_TIME;
}

void PassOrTessellate::take(Incomplete& place, const ScreenPoint& part) {
    if ((place.geometry_left & part.tag.bit()) == 0)
        SC_REPORT_ERROR("tessera/pass_or_tessellate", "a part of a triangle arrived twice");
    place.geometry_left = static_cast<Parts>(place.geometry_left & ~part.tag.bit());
    datapath::TrianglePass& pass = place.triangle.pass;
    const unsigned k = part.tag.index();
    datapath::Vertex& vertex = pass.triangle.vertices[k];
    if (part.tag.is_edge()) {
        pass.new_vertex[k] = {part.p, part.n, part.t, part.code, part.displaced, part.screen};
    } else if (part.tag.is_normal()) {
        vertex.screen_normal = part.n;
    } else {
        vertex.code = part.code;
        vertex.displaced = part.displaced;
        vertex.screen = part.screen;
    }
}

void PassOrTessellate::take(Incomplete& place, const TestedEdge& edge) {
    if ((place.tests_left & edge.tag.bit()) == 0)
        SC_REPORT_ERROR("tessera/pass_or_tessellate", "a part of a triangle arrived twice");
    place.tests_left = static_cast<Parts>(place.tests_left & ~edge.tag.bit());
    datapath::TrianglePass& pass = place.triangle.pass;
    const unsigned k = edge.tag.index();
    pass.edges[k] = edge.found;
    if ((pass.new_vertices >> k & 1) != 0)
        pass.triangle.vertices[k].displaced_normal = edge.displaced_n_i;
}

void PassOrTessellate::b_transport_from_get_triangle(TakenTriangle& taken, sc_core::sc_time&) {
    open(taken);
}

void PassOrTessellate::b_transport_from_transform(ScreenPoint& part, sc_core::sc_time& delay) {
    Incomplete& place = place_of(part.tag);
    take(place, part);
    finish_if_complete(place, part.tag, delay);
}

void PassOrTessellate::b_transport_from_tests(TestedEdge& edge, sc_core::sc_time& delay) {
    Incomplete& place = place_of(edge.tag);
    take(place, edge);
    finish_if_complete(place, edge.tag, delay);
}

PassOrTessellate::Incomplete& PassOrTessellate::place_of(const PartTag& tag) {
    Incomplete* place = incomplete_.find(tag.triangle);
    if (place == nullptr)
        SC_REPORT_ERROR("tessera/pass_or_tessellate", "a part arrived for a triangle that has not arrived");
    return *place;
}

void PassOrTessellate::finish_if_complete(Incomplete& place, const PartTag& tag, sc_core::sc_time& delay) {
    place.latest = std::max(place.latest, delay);
    if (!place.complete())
        return;
    delay = place.latest + latency_;
    // The place is freed first: other triangles may arrive before transport returns.
    const Way way = decide(place.triangle);
    if (way == Way::tessellation) {
        DecidedTriangle triangle = place.triangle;
        incomplete_.close(tag.triangle);
        to_tessellation.transport(triangle, delay);
        return;
    }
    TriangleToLight triangle = to_light(place.triangle.origin, place.triangle.pass.triangle);
    incomplete_.close(tag.triangle);
    if (way == Way::lighting)
        to_lighting.transport(triangle, delay);
}

/// Returns null if all places are taken, or if the triangle itself has not arrived.
PassOrTessellate::Incomplete* PassOrTessellate::open_place(const PartTag& tag, std::uint64_t cycle) {
    if (incomplete_.size() == timing_.buffer || from_get_triangle.empty())
        return nullptr;
    const TakenTriangle& next = from_get_triangle.front();
    if (next.tag != tag.triangle)
        SC_REPORT_ERROR("tessera/pass_or_tessellate", "a part arrived for a triangle that has not arrived");
    open(next);
    from_get_triangle.pop();
    activity_.item_in(cycle);
    most_incomplete_ = std::max(most_incomplete_, incomplete_.size());
    return incomplete_.find(tag.triangle);
}

void PassOrTessellate::take_parts(std::uint64_t cycle) {
    for (; !from_transform.empty(); from_transform.pop()) {
        const ScreenPoint& part = from_transform.front();
        Incomplete* place = incomplete_.find(part.tag.triangle);
        if (place == nullptr)
            place = open_place(part.tag, cycle);
        if (place == nullptr)
            break;
        take(*place, part);
    }
    for (StreamInput<TestedEdge>& input : from_tessellation_tests) {
        for (; !input.empty(); input.pop()) {
            Incomplete* place = incomplete_.find(input.front().tag.triangle);
            if (place == nullptr)
                break;
            take(*place, input.front());
        }
    }
}

bool PassOrTessellate::deliver(Decided& next) {
    switch (next.way) {
        case Way::tessellation: return to_tessellation.deliver(next.to_tessellation);
        case Way::lighting: return to_lighting.deliver(next.to_lighting);
        case Way::dropped: break;
    }
    return true;
}

void PassOrTessellate::step() {
    const std::uint64_t cycle = now();
    if (cycle > stepped_)
        most_ahead_of_parts_ = std::max(most_ahead_of_parts_, ahead_of_parts_);
    stepped_ = cycle;
    while (pipeline_.front_finished(cycle) && deliver(pipeline_.front())) {
        pipeline_.pop();
        activity_.item_out(cycle);
    }
    for (bool place_freed = true; place_freed;) {
        take_parts(cycle);
        place_freed = false;
        while (first_is_complete() && pipeline_.may_start(cycle)) {
            Decided& next = pipeline_.start(cycle);
            DecidedTriangle& triangle = incomplete_.oldest().triangle;
            next.way = decide(triangle);
            if (next.way == Way::tessellation)
                next.to_tessellation = triangle;
            else if (next.way == Way::lighting)
                next.to_lighting = to_light(triangle.origin, triangle.pass.triangle);
            incomplete_.close_oldest();
            clock_.progress();
            place_freed = true;
        }
    }
    ahead_of_parts_ = from_get_triangle.size();
    if (!to_lighting.free())
        activity_.set(cycle, State::blocked, to_lighting.consumer());
    else if (!to_tessellation.free())
        activity_.set(cycle, State::blocked, to_tessellation.consumer());
    else if (!pipeline_.empty() || first_is_complete())
        activity_.set(cycle, State::busy);
    else
        activity_.set(cycle, State::starved, late_branch());
    wake_at(pipeline_.next_finished(cycle));
    if (!incomplete_.empty())
        wake_at(pipeline_.next_start(cycle));
}

/// The branch that alone delays the oldest triangle; null if parts are missing from both branches, when neither is the
/// cause, or from neither.
const sc_core::sc_object* PassOrTessellate::late_branch() const {
    if (incomplete_.empty()) {
        for (const StreamInput<TestedEdge>& input : from_tessellation_tests)
            if (!input.empty())
                return transform_;
        return nullptr;
    }
    const Incomplete& first = incomplete_.oldest();
    if (first.geometry_left == 0)
        return tests_[tests_.size() == 1 ? 0
                                         : static_cast<std::size_t>(__builtin_ctz(first.tests_left)) - first_edge_part];
    return first.tests_left == 0 ? transform_ : nullptr;
}

std::string PassOrTessellate::describe_contents() const {
    std::string text;
    const auto add = [&](const std::string& what) { text = listed(text, what, "; "); };
    if (!incomplete_.empty()) {
        const Incomplete& first = incomplete_.oldest();
        add(count_of(incomplete_.size(), "triangle") + " to be joined, the first (" +
            std::to_string(first.triangle.origin.pass) + ") " +
            (first_is_complete()        ? "complete"
             : first.geometry_left == 0 ? "waiting for Tessellation Tests"
             : first.tests_left == 0    ? "waiting for Transform"
                                        : "waiting for both branches"));
    }
    add(count_of(pipeline_.size(), "decided triangle"));
    std::size_t edges = 0;
    for (const StreamInput<TestedEdge>& input : from_tessellation_tests)
        edges += input.size();
    add(count_of(edges, "tested edge") + (edges > 0 ? " that arrived before its triangle had a place" : ""));
    return text;
}

PassOrTessellate::Way PassOrTessellate::decide(DecidedTriangle& whole) {
    const auto& [first, second, third] = whole.pass.edges;
    const Way way = join(whole.pass);
    last_ = {whole.origin, {first.tests, second.tests, third.tests}, whole.pass.split, way};
    return way;
}

PassOrTessellate::Way PassOrTessellate::join(datapath::TrianglePass& pass) {
    datapath::Triangle& triangle = pass.triangle;
    for (unsigned k = 0; k < 3; ++k) {
        datapath::Vertex& vertex = triangle.vertices[k];
        vertex.displaced_known = true;
        if ((unsigned{pass.new_normals} >> k & 1u) != 0)
            vertex.screen_normal_known = true;
    }
    if (!pass.tested) {
        ++counts_.normal_passes;
        return finish(triangle);
    }
    decide_edges(pass);
    decided.write(pass);
    if (pass.split != 0)
        return Way::tessellation;
    if (pass.new_vertices != 0) {
        triangle.finished = true;
        return Way::tessellation;
    }
    return finish(triangle);
}

/// Shows the triangle decided last. After a pass for normals only, its tests and split are those of the earlier pass.
void PassOrTessellate::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.input(from_transform, "from_transform");
    for (const StreamInput<TestedEdge>& input : from_tessellation_tests)
        signals.input(input, input.basename());
    signals.value("incomplete", 16, incomplete_.size());
    const std::uint64_t decided_so_far = counts_.passes + counts_.normal_passes;
    signals.pulse("decided", decided_so_far);
    if (signals.when(signals.changed("shown", decided_so_far) && !pipeline_.empty())) {
        signals.value("triangle", 32, last_.origin.pass);
        signals.value("base", 32, last_.origin.base);
        signals.value("tests_0", 5, last_.tests[0]);
        signals.value("tests_1", 5, last_.tests[1]);
        signals.value("tests_2", 5, last_.tests[2]);
        if (registers_.tests.highlight_test) {
            unsigned highlight = 0;
            for (unsigned k = 0; k < 3; ++k)
                highlight |= (last_.tests[k] & datapath::highlight_bit) != 0 ? 1u << k : 0u;
            signals.value("highlight", 3, highlight);
        }
        signals.value("split", 3, last_.split);
        signals.value("way", 2, static_cast<std::uint64_t>(last_.way));
    }
    signals.value("finished", 32, counts_.finished);
}

}  // namespace tessera
