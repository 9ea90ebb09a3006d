#include "modules/units/family/tessellation.h"

#include <algorithm>

#include "modules/datapath/tessellate.h"
#include "modules/stage/signals.h"

namespace tessera {

FamilyTessellation::FamilyTessellation(const sc_core::sc_module_name& name, const UnitContext& context)
    : TessellatingUnit(name, context),
      to_tessellation_tests("to_tessellation_tests", context.design.edge_lanes),
      latency_(clock_.period() * timing_.latency),
      lanes_(context.design.edge_lanes) {
    const StallParameters& stalls = context.timing().stalls;
    from_get_triangle.register_b_transport<&FamilyTessellation::b_transport_from_get_triangle>(*this);
    from_get_triangle.clocked_by(clock_, *this, triangles_ahead_of_parts(context.design), stalls);
    from_transform.register_b_transport<&FamilyTessellation::b_transport_from_transform>(*this);
    from_transform.clocked_by(clock_, *this, timing_.buffer, stalls);
    to_pass_or_tessellate.clocked_by(context, *this);
    for (unsigned k = 0; k < lanes_.size(); ++k) {
        to_tessellation_tests[k].clocked_by(context, *this);
        lanes_[k].output = &to_tessellation_tests[k];
        lanes_[k].takes = parts_for_lane(k, context.design.edge_lanes);
    }
    const ItemWidths bits(context);
    constexpr std::uint64_t midpoints = 3;
    area_.register_bits += (from_get_triangle.depth() + 1) * bits.of<TakenTriangle>() +
                           (timing_.buffer + midpoints) * bits.of<ScreenPoint>() + bits.of<Family>() +
                           lanes_.size() * bits.of<TestOperands>();
}

void FamilyTessellation::end_of_elaboration() {
    transform_ = module_behind(from_transform.get_base_port().get_interface());
}

void FamilyTessellation::open(Joined& joined, const TakenTriangle& taken) {
    joined.taken = taken;
    joined.left = parts_of(taken.triangle, Work::family);
    joined.untested = (joined.left & vertex_parts) != 0;
    joined.latest = sc_core::SC_ZERO_TIME;
}

void FamilyTessellation::take(Joined& joined, const ScreenPoint& part) {
    if (part.tag.triangle != joined.taken.tag || (joined.left & part.tag.bit()) == 0)
        SC_REPORT_ERROR("tessera/tessellation", "a part arrived twice, or for a triangle that has not arrived");
    joined.left = static_cast<Parts>(joined.left & ~part.tag.bit());
    const unsigned k = part.tag.index();
    datapath::Vertex& vertex = joined.taken.triangle.vertices[k];
    if (part.tag.is_edge()) {
        joined.made[k] = {part.p, part.n, part.t, part.code, part.displaced, part.screen, part.displaced_n, true};
    } else {
        vertex.code = part.code;
        vertex.displaced = part.displaced;
        vertex.displaced_normal = part.n;
        vertex.screen = part.screen;
        vertex.screen_normal = part.displaced_n;
        vertex.displaced_known = vertex.screen_normal_known = true;
    }
}

/// Determines the inserted vertices, the diagonal, and the new edges.
void FamilyTessellation::tessellate(const Joined& joined, Sent& sent) {
    const datapath::Triangle& triangle = joined.taken.triangle;
    Family& family = sent.family;
    family.tag = joined.taken.tag;
    family.origin = joined.taken.origin;
    family.triangle = triangle;
    family.untested = joined.untested;
    datapath::TrianglePass pass;
    pass.number = triangle.parent;
    pass.triangle = triangle;
    pass.split = triangle.split;
    pass.told = datapath::Told::midpoints;
    for (unsigned k = 0; k < 3; ++k) {
        family.vertices[k] = triangle.vertices[k];
        if ((triangle.split >> k & 1u) == 0)
            continue;
        const datapath::TestedMidpoint& found = triangle.midpoints[k];
        pass.new_vertex[k] = joined.made[k];
        pass.edges[k] = {joined.made[k].texture, found.normal, found.tangent, found.displaced_normal,
                         triangle.split_by};
        datapath::Vertex& vertex = family.vertices[3 + k];
        vertex = inserted_vertex(pass, static_cast<int>(k));
        vertex.generation = datapath::kept_generation(vertex.generation, registers_.formats, saturations_);
    }
    family.second_diagonal = datapath::choose_second_diagonal(
        triangle.split, registers_.triangulation,
        [&](std::uint8_t index) -> const datapath::Position& { return family.vertices[index].displaced; });
    const datapath::ChildIndices children = datapath::triangulate(triangle.split, family.second_diagonal);
    sent.edges = datapath::family_edges(children, datapath::open_edges(family.untested, triangle.uncut));
    sent.parts = parts_of(sent.edges);
    if (family.untested)
        return;
    ++made_into_[static_cast<std::size_t>(children.count)];
    inserted.write(pass);
}

TestOperands FamilyTessellation::operands(const Sent& sent, Parts part) {
    TestOperands item;
    item.tag = {sent.family.tag, static_cast<std::uint8_t>(__builtin_ctz(part)), sent.family.origin};
    const datapath::FamilyEdges::Ends& ends = sent.edges.edges[item.tag.part - first_edge_part];
    item.ends = {EdgeEnd::of(sent.family.vertices[ends.i]), EdgeEnd::of(sent.family.vertices[ends.j])};
    return item;
}

void FamilyTessellation::b_transport_from_get_triangle(TakenTriangle& taken, sc_core::sc_time&) {
    open(joined_.open(taken.tag) = {}, taken);
}

void FamilyTessellation::b_transport_from_transform(ScreenPoint& part, sc_core::sc_time& delay) {
    Joined* joined = joined_.find(part.tag.triangle);
    if (joined == nullptr)
        SC_REPORT_ERROR("tessera/tessellation", "a part arrived for a triangle that has not arrived");
    take(*joined, part);
    joined->latest = std::max(joined->latest, delay);
    if (joined->left != 0)
        return;
    const sc_core::sc_time start = joined->latest + latency_;
    Sent sent;
    tessellate(*joined, sent);
    joined_.close(part.tag.triangle);
    delay = start;
    to_pass_or_tessellate.transport(sent.family, delay);
    for (PartSender<TestOperands>& lane : lanes_)
        lane.transport(sent.parts, start, delay, [&](TestOperands& item, Parts edge) { item = operands(sent, edge); });
}

/// Takes the parts that have arrived. Returns true if a triangle has all its parts.
bool FamilyTessellation::join() {
    while (joined_.empty() || joined_.oldest().left != 0) {
        if (from_transform.empty())
            return false;
        if (joined_.empty()) {
            if (from_get_triangle.empty())
                return false;
            open(joined_.open(from_get_triangle.front().tag), from_get_triangle.front());
            from_get_triangle.pop();
        }
        take(joined_.oldest(), from_transform.front());
        from_transform.pop();
    }
    return true;
}

/// Returns true if Pass or Tessellate has accepted the family, and so has a place for its edges.
bool FamilyTessellation::send_family() {
    if (family_sent_)
        return to_pass_or_tessellate.free();
    family_sent_ = true;
    return to_pass_or_tessellate.send(sent_.family);
}

/// Returns true if all edges have been accepted.
bool FamilyTessellation::send_parts(std::uint64_t cycle) {
    bool all = true;
    for (PartSender<TestOperands>& lane : lanes_) {
        const bool lane_done = lane.send(
            cycle, timing_.interval,
            [this](TestOperands& item, Parts part) {
                item = operands(sent_, part);
                ++parts_sent_;
            },
            [this](std::uint64_t later) { wake_at(later); });
        all = all && lane_done;
    }
    return all;
}

void FamilyTessellation::step() {
    const std::uint64_t cycle = now();
    most_ahead_of_parts_ = std::max(most_ahead_of_parts_, from_get_triangle.size());
    for (bool joined = join();; joined = join()) {
        if (sending_) {
            if (start_ > cycle)
                wake_at(start_);
            if (start_ > cycle || !send_family())
                break;
            if (!send_parts(cycle))
                break;
            sending_ = false;
            activity_.item_out(cycle);
        }
        if (!joined)
            break;
        tessellate(joined_.oldest(), sent_);
        joined_.close_oldest();
        sending_ = true;
        family_sent_ = false;
        start_ = cycle + timing_.latency;
        activity_.item_in(cycle);
        std::uint64_t most = 1;
        for (PartSender<TestOperands>& lane : lanes_) {
            lane.begin(sent_.parts, start_);
            most = std::max<std::uint64_t>(most, static_cast<unsigned>(__builtin_popcount(lane.left)));
        }
        most_parts_ += most;
    }
    const sc_core::sc_object* blocker = to_pass_or_tessellate.free() ? nullptr : to_pass_or_tessellate.consumer();
    for (const StreamOutput<TestOperands>& output : to_tessellation_tests)
        if (!output.free())
            blocker = output.consumer();
    if (blocker != nullptr)
        activity_.set(cycle, State::blocked, blocker);
    else
        activity_.set(cycle, sending_ ? State::busy : State::starved, sending_ ? nullptr : transform_);
}

std::string FamilyTessellation::describe_contents() const {
    std::string text;
    if (!joined_.empty())
        text = "triangle " + std::to_string(joined_.oldest().taken.origin.pass) +
               (joined_.oldest().left == 0 ? ", complete" : ", waiting for parts");
    if (sending_)
        text = listed(text, "triangle " + std::to_string(sent_.family.origin.pass) + ", partly sent");
    return listed(text, count_of(from_get_triangle.size(), "triangle") +
                            (from_get_triangle.empty() ? "" : " that wait for their parts"));
}

void FamilyTessellation::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.input(from_get_triangle, "from_get_triangle");
    signals.input(from_transform, "from_transform");
    if (signals.when(signals.changed("begun", activity_.items_in()) && sending_)) {
        signals.value("triangle", 32, sent_.family.origin.pass);
        signals.value("base", 32, sent_.family.origin.base);
        signals.value("split", 3, sent_.family.triangle.split);
        signals.flag("second_diagonal", sent_.family.second_diagonal);
        signals.flag("untested", sent_.family.untested);
        signals.value("new_edges", 4, sent_.edges.count);
    }
    Parts left = 0;
    for (const PartSender<TestOperands>& lane : lanes_)
        left = static_cast<Parts>(left | lane.left);
    signals.value("left", 15, left);
    signals.value("parts_sent", 32, parts_sent_);
}

}  // namespace tessera
