#include "modules/units/pass_or_tessellate.h"

#include <algorithm>
#include <string>

#include "modules/datapath/cull.h"
#include "modules/datapath/edge_tests.h"
#include "modules/unit/signals.h"

namespace tessera {

PassOrTessellate::PassOrTessellate(const sc_core::sc_module_name& name, Clock& clock,
                                   const datapath::Registers& registers, const Timing& timing,
                                   unsigned tests_units, PassPool& passes)
    : Unit(name, clock),
      from_tessellation_tests("from_tessellation_tests", tests_units),
      registers_(registers),
      timing_(timing.pass_or_tessellate),
      passes_(passes),
      incomplete_(timing.pass_or_tessellate.buffer),
      pipeline_(timing.pass_or_tessellate) {
    from_transform.serve<&PassOrTessellate::b_transport_from_transform>(*this);
    from_transform.clocked_by(clock, *this, 1, timing.stalls);
    for (StreamInput<Work>& input : from_tessellation_tests) {
        input.serve<&PassOrTessellate::b_transport_from_tests>(*this);
        input.clocked_by(clock, *this, timing_.buffer * 3 / tests_units, timing.stalls);
    }
    to_tessellation.clocked_by(clock, *this);
    to_lighting.clocked_by(clock, *this);
}

void PassOrTessellate::end_of_elaboration() {
    transform_ = module_behind(from_transform.get_base_port().get_interface());
    for (StreamInput<Work>& input : from_tessellation_tests)
        tests_.push_back(module_behind(input.get_base_port().get_interface()));
}

/// The place of a part's triangle, opened for it if it has none.
PassOrTessellate::Incomplete& PassOrTessellate::place_of(const Work& part) {
    Incomplete* place = incomplete_.find(part.tag());
    if (place == nullptr) {
        place = &incomplete_.open(part.tag());
        place->pass = part.pass;
        place->geometry_left = parts_of(*part.pass);
        place->tests_left = static_cast<Parts>(parts_of(*part.pass) & edge_parts);
    }
    return *place;
}

void PassOrTessellate::take(Parts& left, const Work& part) const {
    if ((left & part.parts) != part.parts)
        SC_REPORT_ERROR("tessera/pass_or_tessellate", "a part of a triangle came twice");
    left = static_cast<Parts>(left & ~part.parts);
}

void PassOrTessellate::b_transport_from_transform(Work& work, sc_core::sc_time& delay) {
    Incomplete& triangle = place_of(work);
    take(triangle.geometry_left, work);
    finish_if_complete(triangle, work, delay);
}

void PassOrTessellate::b_transport_from_tests(Work& work, sc_core::sc_time& delay) {
    Incomplete* triangle = incomplete_.find(work.tag());
    if (triangle == nullptr)
        SC_REPORT_ERROR("tessera/pass_or_tessellate", "the two branches brought different triangles");
    take(triangle->tests_left, work);
    finish_if_complete(*triangle, work, delay);
}

void PassOrTessellate::finish_if_complete(Incomplete& triangle, const Work& part, sc_core::sc_time& delay) {
    triangle.latest = std::max(triangle.latest, delay);
    if (!triangle.complete())
        return;
    delay = triangle.latest + clock_.period() * timing_.latency;
    incomplete_.close(part.tag());
    Work whole{part.pass, parts_of(*part.pass)};
    switch (join(*part.pass)) {
        case Way::tessellation:
            to_tessellation->b_transport(whole, delay);
            break;
        case Way::lighting:
            to_lighting->b_transport(part.pass->triangle, delay);
            break;
        case Way::dropped:
            break;
    }
}

bool PassOrTessellate::take_parts(std::uint64_t cycle) {
    bool taken = false;
    for (; !from_transform.empty(); from_transform.pop()) {
        const Work& part = from_transform.front();
        if (incomplete_.find(part.tag()) == nullptr) {
            if (incomplete_.size() == timing_.buffer)
                break;
            activity_.item_in(cycle);
        }
        take(place_of(part).geometry_left, part);
        most_incomplete_ = std::max(most_incomplete_, incomplete_.size());
        taken = true;
    }
    for (StreamInput<Work>& input : from_tessellation_tests) {
        for (; !input.empty(); input.pop()) {
            Incomplete* triangle = incomplete_.find(input.front().tag());
            if (triangle == nullptr)
                break;
            take(triangle->tests_left, input.front());
            taken = true;
        }
    }
    return taken;
}

bool PassOrTessellate::deliver(Decided& next) {
    switch (next.way) {
        case Way::tessellation:
            return to_tessellation.deliver(next.work);
        case Way::lighting:
            if (!to_lighting.deliver(next.work.pass->triangle))
                return false;
            break;
        case Way::dropped:
            break;
    }
    passes_.give_back(*next.work.pass);
    return true;
}

void PassOrTessellate::step() {
    const std::uint64_t cycle = now();
    while (pipeline_.front_finished(cycle) && deliver(pipeline_.front())) {
        pipeline_.pop();
        activity_.item_out(cycle);
    }
    bool changed = true;
    while (changed) {
        changed = take_parts(cycle);
        while (first_is_complete() && pipeline_.may_start(cycle)) {
            Pass& pass = *incomplete_.oldest().state.pass;
            incomplete_.close_oldest();
            Decided& next = pipeline_.start(cycle);
            next.work = {&pass, parts_of(pass)};
            next.way = join(pass);
            clock_.progress();
            changed = true;
        }
    }
    if (!to_lighting.free())
        activity_.set(cycle, State::blocked, to_lighting.consumer());
    else if (!to_tessellation.free())
        activity_.set(cycle, State::blocked, to_tessellation.consumer());
    else if (!pipeline_.empty() || first_is_complete())
        activity_.set(cycle, State::busy);
    else
        activity_.set(cycle, State::starved, lacks());
    wake_at(pipeline_.next_finished(cycle));
    if (!incomplete_.empty())
        wake_at(pipeline_.next_start(cycle));
}

/// The branch of which something lacks while all of the other's is there; null: neither is late.
const sc_core::sc_object* PassOrTessellate::lacks() const {
    if (incomplete_.empty()) {
        for (const StreamInput<Work>& input : from_tessellation_tests) {
            if (!input.empty())
                return transform_;
        }
        return nullptr;
    }
    const Incomplete& first = incomplete_.oldest().state;
    if (first.geometry_left == 0)
        return tests_[tests_.size() == 1 ? 0 : Work{nullptr, first.tests_left}.index()];
    return first.tests_left == 0 ? transform_ : nullptr;
}

std::string PassOrTessellate::holds() const {
    std::string text;
    const auto add = [&](const std::string& what) { text = listed(text, what, "; "); };
    if (!incomplete_.empty()) {
        const Incomplete& first = incomplete_.oldest().state;
        add(count_of(incomplete_.size(), "triangle") + " to be joined, the first (" +
            std::to_string(incomplete_.oldest().tag) + ") " +
            (first_is_complete()        ? "complete"
             : first.geometry_left == 0 ? "lacks its parts from Tessellation Tests"
             : first.tests_left == 0    ? "lacks its parts from Transform"
                                        : "lacks its parts from both branches"));
    }
    add(count_of(pipeline_.size(), "decided triangle"));
    std::size_t edges = 0;
    for (const StreamInput<Work>& input : from_tessellation_tests)
        edges += input.size();
    add(count_of(edges, "tested edge") + (edges > 0 ? " that came before its triangle's place" : ""));
    return text;
}

PassOrTessellate::Way PassOrTessellate::join(Pass& pass) {
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

void PassOrTessellate::decide_edges(datapath::TrianglePass& pass) {
    ++counts_.passes;
    unsigned split = 0;
    unsigned stopped_by = 0;
    for (unsigned k = 0; k < 3; ++k) {
        const datapath::EdgeTests& edge = pass.edges[k];
        if (!(edge.texture == pass.new_vertex[k].texture))
            SC_REPORT_ERROR("tessera/pass_or_tessellate",
                            "the two branches disagree on the midpoint of an edge");
        const unsigned wanted = edge.tests & datapath::requesting_tests;
        if (datapath::split_decision(edge.tests)) {
            split |= 1u << k;
            ++counts_.edges_split;
            const unsigned by = wanted & (datapath::normal_bit | datapath::summed_height_bit);
            counts_.split_by_normal += by == datapath::normal_bit;
            counts_.split_by_summed_height += by == datapath::summed_height_bit;
            counts_.split_by_both += by == (datapath::normal_bit | datapath::summed_height_bit);
            counts_.split_by_highlight += by == 0;
            counts_.split_in_highlight += (wanted & datapath::highlight_bit) != 0;
        } else if (wanted != 0) {
            const unsigned missing = ~edge.tests & datapath::gating_tests;
            stopped_by |= missing;
            counts_.stopped_by_view += (missing & datapath::view_bit) != 0;
            counts_.stopped_by_tex_coord += (missing & datapath::tex_coord_bit) != 0;
            counts_.stopped_by_generation += (missing & datapath::generation_bit) != 0;
            counts_.stopped_by_view_alone += missing == datapath::view_bit;
            counts_.stopped_by_tex_coord_alone += missing == datapath::tex_coord_bit;
            counts_.stopped_by_generation_alone += missing == datapath::generation_bit;
            counts_.stopped_by_several += (missing & (missing - 1)) != 0;
        }
    }
    pass.split = static_cast<std::uint8_t>(split);
    pass.triangle.stopped_by = static_cast<std::uint8_t>(stopped_by);
}

PassOrTessellate::Way PassOrTessellate::finish(datapath::Triangle& triangle) {
    triangle.finished = true;
    ++counts_.finished;
    finished.write(triangle);
    const auto& v = triangle.vertices;
    if (registers_.back_face_culling && datapath::faces_away(v[0].screen, v[1].screen, v[2].screen)) {
        ++counts_.culled;
        return Way::dropped;
    }
    return Way::lighting;
}

/// Shows the triangle decided last; of one that only fetched normals, tests and split as it brought them.
void PassOrTessellate::show(Signals& signals) const {
    Unit::show(signals);
    signals.input(from_transform, "from_transform");
    for (const StreamInput<Work>& input : from_tessellation_tests)
        signals.input(input, input.basename());
    signals.value("incomplete", 16, incomplete_.size());
    const std::uint64_t decided_so_far = counts_.passes + counts_.normal_passes;
    signals.pulse("decided", decided_so_far);
    signals.group(signals.changed(decided_so_far) && !pipeline_.empty(), [&] {
        const Decided& last = pipeline_.newest();
        const Pass& pass = Signals::pass_of(last.work);
        signals.value("triangle", 32, pass.number);
        signals.value("base", 32, pass.triangle.base);
        signals.value("tests_0", 5, pass.edges[0].tests);
        signals.value("tests_1", 5, pass.edges[1].tests);
        signals.value("tests_2", 5, pass.edges[2].tests);
        if (registers_.tests.highlight_test) {
            unsigned highlight = 0;
            for (unsigned k = 0; k < 3; ++k)
                highlight |= (pass.edges[k].tests & datapath::highlight_bit) != 0 ? 1u << k : 0u;
            signals.value("highlight", 3, highlight);
        }
        signals.value("split", 3, pass.split);
        signals.value("way", 2, static_cast<std::uint64_t>(last.way));
    });
    signals.value("finished", 32, counts_.finished);
}

}  // namespace tessera
