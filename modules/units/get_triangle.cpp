#include "modules/units/get_triangle.h"

#include <algorithm>

#include "modules/unit/signals.h"

namespace tessera {

GetTriangle::GetTriangle(const sc_core::sc_module_name& name, Clock& clock, const Timing& timing,
                         unsigned tests_units, PassPool& passes)
    : Unit(name, clock),
      to_tessellation_tests("to_tessellation_tests", tests_units),
      timing_(timing.get_triangle),
      passes_(passes) {
    from_host.serve<&GetTriangle::b_transport_from_host>(*this);
    from_triangle_queue.serve<&GetTriangle::b_transport_from_triangle_queue>(*this);
    from_host.clocked_by(clock, *this, timing_.buffer, timing.stalls);
    from_triangle_queue.clocked_by(clock, *this, timing_.buffer, timing.stalls);
    const auto add = [&](StreamOutput<Work>& output, Parts takes) {
        output.clocked_by(clock, *this);
        branches_[branch_count_].output = &output;
        branches_[branch_count_++].takes = takes;
    };
    add(to_calculate_new_p, all_parts);
    for (unsigned k = 0; k < tests_units; ++k)
        add(to_tessellation_tests[k], parts_for_tests(k, tests_units));
}

void GetTriangle::prepare(datapath::TrianglePass& pass) {
    pass.new_vertices = 0;
    pass.new_normals = 0;
    pass.split = 0;
    pass.tested = !pass.triangle.finished;
    for (unsigned k = 0; k < 3; ++k) {
        const datapath::Vertex& vertex = pass.triangle.vertices[k];
        if (!vertex.displaced_known)
            pass.new_vertices = static_cast<std::uint8_t>(pass.new_vertices | 1u << k);
        else if (!vertex.screen_normal_known)
            pass.new_normals = static_cast<std::uint8_t>(pass.new_normals | 1u << k);
    }
}

void GetTriangle::send_whole(const datapath::Triangle& triangle, sc_core::sc_time& delay) {
    Pass pass;
    pass.number = passes_.next_tag();
    pass.triangle = triangle;
    prepare(pass);
    delay += clock_.period() * timing_.latency;
    const sc_core::sc_time start = delay;
    for (unsigned k = 0; k < branch_count_; ++k) {
        if (k > 0 && !pass.tested)
            break;
        Work work{&pass, static_cast<Parts>(parts_of(pass) & branches_[k].takes)};
        sc_core::sc_time its_delay = start;
        (*branches_[k].output)->b_transport(work, its_delay);
        delay = std::max(delay, its_delay);
    }
}

void GetTriangle::b_transport_from_host(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    while (!queue_level->takes_host_triangles())
        wait(queue_level->host_may_send());
    ++host_triangles_;
    send_whole(triangle, delay);
}

void GetTriangle::b_transport_from_triangle_queue(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    ++queue_triangles_;
    send_whole(triangle, delay);
}

bool GetTriangle::begin(std::uint64_t cycle) {
    StreamInput<datapath::Triangle>* source = nullptr;
    if (!from_triangle_queue.empty()) {
        source = &from_triangle_queue;
        ++queue_triangles_;
    } else if (!from_host.empty() && queue_level->takes_host_triangles()) {
        source = &from_host;
        ++host_triangles_;
    } else {
        return false;
    }
    pass_ = &passes_.take();
    pass_->triangle = source->front();
    source->pop();
    prepare(*pass_);
    activity_.item_in(cycle);
    for (unsigned k = 0; k < branch_count_; ++k) {
        Branch& branch = branches_[k];
        branch.left = static_cast<Parts>(k == 0 || pass_->tested ? parts_of(*pass_) & branch.takes : 0);
        branch.next = std::max(branch.next, cycle + timing_.latency);
    }
    return true;
}

/// True: nothing left to send, and nothing on offer.
bool GetTriangle::send_parts(Branch& branch, std::uint64_t cycle) {
    if (!branch.output->free())
        return false;
    if (branch.left == 0)
        return true;
    if (branch.next > cycle) {
        wake_at(branch.next);
        return false;
    }
    const auto part = static_cast<Parts>(branch.left & -branch.left);
    branch.left = static_cast<Parts>(branch.left & ~part);
    branch.offered = {pass_, part};
    branch.next = cycle + timing_.interval;
    if (&branch == branches_.data())
        ++parts_sent_;
    const bool taken = branch.output->send(branch.offered);
    if (branch.left != 0)
        wake_at(branch.next);
    return taken && branch.left == 0;
}

void GetTriangle::step() {
    const std::uint64_t cycle = now();
    for (;;) {
        if (pass_ == nullptr && !begin(cycle))
            break;
        bool all = true;
        for (unsigned k = 0; k < branch_count_; ++k)
            all = send_parts(branches_[k], cycle) && all;
        if (!all)
            break;
        pass_ = nullptr;
        activity_.item_out(cycle);
    }
    const sc_core::sc_object* blocker = nullptr;
    for (unsigned k = 0; k < branch_count_ && blocker == nullptr; ++k) {
        if (!branches_[k].output->free())
            blocker = branches_[k].output->consumer();
    }
    if (blocker != nullptr)
        activity_.set(cycle, State::blocked, blocker);
    else
        activity_.set(cycle, pass_ != nullptr ? State::busy : State::starved);
}

std::string GetTriangle::holds() const {
    std::string text;
    if (pass_ != nullptr)
        text = "triangle " + std::to_string(pass_->number) + ", not all of it sent";
    if (!from_host.empty())
        text = listed(text, queue_level->takes_host_triangles()
                                ? "a host triangle"
                                : "a host triangle it may not take: the queue is at its watermark");
    return listed(text, from_triangle_queue.empty() ? "" : "a triangle from the queue");
}

void GetTriangle::show(Signals& signals) const {
    Unit::show(signals);
    signals.input(from_host, "from_host");
    signals.input(from_triangle_queue, "from_triangle_queue");
    signals.group(signals.changed(activity_.items_in()) && pass_ != nullptr, [&] {
        const Pass& pass = Signals::pass_of({pass_, 0});
        signals.value("triangle", 32, pass.number);
        signals.value("base", 32, pass.triangle.base);
        signals.value("new_vertices", 3, pass.new_vertices);
        signals.value("new_normals", 3, pass.new_normals);
        signals.flag("tested", pass.tested);
    });
    signals.group(signals.changed(parts_sent_),
                  [&] { signals.value("part", Signals::part_bits, Signals::part_of(branches_[0].offered)); });
    Parts tests_left = 0;
    for (unsigned k = 1; k < branch_count_; ++k)
        tests_left = static_cast<Parts>(tests_left | branches_[k].left);
    signals.value("geometry_left", 9, branches_[0].left);
    signals.value("tests_left", 9, tests_left);
    signals.value("host_triangles", 32, host_triangles_);
    signals.value("queue_triangles", 32, queue_triangles_);
}

}  // namespace tessera
