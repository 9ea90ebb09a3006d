#include "modules/units/get_triangle.h"

#include <algorithm>

#include "modules/stage/signals.h"

namespace tessera {
namespace {

PartTag tag_of(const TakenTriangle& taken, Parts part) {
    return {taken.tag, static_cast<std::uint8_t>(__builtin_ctz(part)), taken.origin};
}

void make(GeometryOperands& item, const TakenTriangle& taken, Parts part, Work work) {
    item.tag = tag_of(taken, part);
    const unsigned k = item.tag.index();
    const datapath::Vertex& i = taken.triangle.vertices[k];
    item.p_i = i.position;
    item.n_i = item.tag.is_normal() ? i.displaced_normal : i.normal;
    item.t_i = i.texture;
    if (work == Work::family && item.tag.is_vertex()) {
        item.n_j = i.tangent;
        item.handedness = i.handedness;
    }
    if (!item.tag.is_edge())
        return;
    const datapath::Vertex& j = taken.triangle.vertices[(k + 1) % 3];
    item.p_j = j.position;
    item.n_j = j.normal;
    item.t_j = j.texture;
    if (work == Work::family) {
        item.n_i = taken.triangle.midpoints[k].normal;
        item.n_j = taken.triangle.midpoints[k].displaced_normal;
    }
}

void make(TestOperands& item, const TakenTriangle& taken, Parts part, Work) {
    item.tag = tag_of(taken, part);
    item.new_vertices = static_cast<std::uint8_t>(parts_of(taken.triangle) & vertex_parts);
    const unsigned k = item.tag.index();
    item.ends[0] = EdgeEnd::of(taken.triangle.vertices[k]);
    if (item.tag.is_edge())
        item.ends[1] = EdgeEnd::of(taken.triangle.vertices[(k + 1) % 3]);
}

/// No edge of a finished triangle is tested again.
Parts parts_to_test(const datapath::Triangle& triangle) {
    return triangle.finished ? Parts{0} : parts_of(triangle);
}

}  // namespace

GetTriangle::GetTriangle(const sc_core::sc_module_name& name, const UnitContext& context)
    : Unit(name, context.clock),
      to_tessellation_tests("to_tessellation_tests",
                            context.design.work == Work::family ? 0 : context.design.tests_units),
      to_join(context.design.work == Work::family ? "to_tessellation" : "to_pass_or_tessellate"),
      timing_(context.timing().get_triangle),
      latency_(clock_.period() * timing_.latency),
      tag_mask_(static_cast<Tag>((std::uint64_t{1} << tag_bits_in_use(context.design)) - 1)),
      work_(context.design.work),
      tests_units_(to_tessellation_tests.size()) {
    const Timing& timing = context.timing();
    from_host.register_b_transport<&GetTriangle::b_transport_from_host>(*this);
    from_triangle_queue.register_b_transport<&GetTriangle::b_transport_from_triangle_queue>(*this);
    queue_level.register_b_transport<&GetTriangle::b_transport_level>(*this);
    from_host.clocked_by(context.clock, *this, timing_.buffer, timing.stalls);
    from_triangle_queue.clocked_by(context.clock, *this, timing_.buffer, timing.stalls);
    queue_level.clocked_by(context.clock, *this, 1, {});  // a wire: it does not stall
    to_join.clocked_by(context, *this);
    to_calculate_new_p.clocked_by(context, *this);
    geometry_.output = &to_calculate_new_p;
    geometry_.takes = all_parts;
    for (unsigned k = 0; k < tests_units_; ++k) {
        to_tessellation_tests[k].clocked_by(context, *this);
        tests_[k].output = &to_tessellation_tests[k];
        tests_[k].takes = parts_for_tests(k, context.design.tests_units);
    }
    const ItemWidths bits(context);
    area_.register_bits +=
        (from_host.depth() + from_triangle_queue.depth()) * bits.of<datapath::Triangle>() + bits.of<TakenTriangle>();
}

TakenTriangle GetTriangle::taken(const datapath::Triangle& triangle) {
    const std::uint32_t pass = passes_++;
    return {pass & tag_mask_, {pass, triangle.base}, triangle};
}

void GetTriangle::send_whole(const datapath::Triangle& triangle, sc_core::sc_time& delay) {
    TakenTriangle whole = taken(triangle);
    delay += latency_;
    const sc_core::sc_time start = delay;
    sc_core::sc_time its_delay = start;
    to_join.transport(whole, its_delay);
    const auto make_part = [&](auto& item, Parts part) { make(item, whole, part, work_); };
    geometry_.transport(parts_of(triangle, work_), start, delay, make_part);
    for (std::size_t k = 0; k < tests_units_; ++k)
        tests_[k].transport(parts_to_test(triangle), start, delay, make_part);
}

void GetTriangle::take_from_host() {
    if (!frame_begun_)
        SC_REPORT_ERROR(
            "tessera/get_triangle",
            (std::string(name()) +
             ": a triangle outside a frame: call Machine::begin_frame() before the first triangle of a "
             "frame and end_frame() after its last, so that drained() can tell when all have left the machine")
                .c_str());
    ++host_triangles_;
}

void GetTriangle::b_transport_from_host(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    while (!below_watermark_) {
        host_waits_ = true;
        wait(host_may_send_);
    }
    take_from_host();
    send_whole(triangle, delay);
}

void GetTriangle::b_transport_from_triangle_queue(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    ++queue_triangles_;
    send_whole(triangle, delay);
}

/// A waiting host has priority over the queue.
void GetTriangle::b_transport_level(QueueLevel& level, sc_core::sc_time& delay) {
    below_watermark_ = level.below_watermark;
    if (!below_watermark_ || !host_waits_)
        return;
    host_waits_ = false;
    host_may_send_.notify();
    wait(delay);
    delay = sc_core::SC_ZERO_TIME;
}

bool GetTriangle::begin(std::uint64_t cycle) {
    StreamInput<datapath::Triangle>* source = nullptr;
    if (!from_triangle_queue.empty()) {
        source = &from_triangle_queue;
        ++queue_triangles_;
    } else if (!from_host.empty() && below_watermark_) {
        source = &from_host;
        take_from_host();
    } else {
        return false;
    }
    taken_ = taken(source->front());
    sending_ = true;
    source->pop();
    activity_.item_in(cycle);
    to_join.send(taken_);
    geometry_.begin(parts_of(taken_.triangle, work_), cycle + timing_.latency);
    for (std::size_t k = 0; k < tests_units_; ++k)
        tests_[k].begin(parts_to_test(taken_.triangle), cycle + timing_.latency);
    return true;
}

/// Returns true if all parts of the triangle have been accepted.
bool GetTriangle::send_parts(std::uint64_t cycle) {
    const auto send = [&](auto& branch) {
        return branch.send(
            cycle, timing_.interval, [this](auto& item, Parts part) { make(item, taken_, part, work_); },
            [this](std::uint64_t later) { wake_at(later); });
    };
    bool all = send(geometry_);
    for (std::size_t k = 0; k < tests_units_; ++k)
        all = send(tests_[k]) && all;
    return all;
}

const sc_core::sc_object* GetTriangle::blocked_by() const {
    if (!to_calculate_new_p.free())
        return to_calculate_new_p.consumer();
    for (const StreamOutput<TestOperands>& output : to_tessellation_tests)
        if (!output.free())
            return output.consumer();
    return to_join.free() ? nullptr : to_join.consumer();
}

void GetTriangle::step() {
    const std::uint64_t cycle = now();
    for (; !queue_level.empty(); queue_level.pop())
        below_watermark_ = queue_level.front().below_watermark;
    for (;;) {
        if (!sending_ && !begin(cycle))
            break;
        const bool whole_sent = to_join.free();
        if (!send_parts(cycle) || !whole_sent)
            break;
        sending_ = false;
        activity_.item_out(cycle);
    }
    const sc_core::sc_object* blocker = blocked_by();
    if (blocker != nullptr)
        activity_.set(cycle, State::blocked, blocker);
    else
        activity_.set(cycle, sending_ ? State::busy : State::starved);
}

std::string GetTriangle::describe_contents() const {
    std::string text;
    if (sending_)
        text = "triangle " + std::to_string(taken_.origin.pass) + ", partly sent";
    if (!from_host.empty())
        text = listed(text, below_watermark_ ? "a host triangle"
                                             : "a host triangle, not accepted because the queue is at its watermark");
    return listed(text, from_triangle_queue.empty() ? "" : "a triangle from the queue");
}

void GetTriangle::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.input(from_host, "from_host");
    signals.input(from_triangle_queue, "from_triangle_queue");
    if (signals.when(signals.changed("begun", activity_.items_in()) && sending_)) {
        const Parts parts = parts_of(taken_.triangle, work_);
        signals.value("triangle", 32, taken_.origin.pass);
        signals.value("base", 32, taken_.origin.base);
        signals.value("new_vertices", 3, parts & vertex_parts);
        signals.value("new_normals", 3, (parts & normal_parts) >> first_normal_part);
        signals.flag("tested", (parts & edge_parts) != 0);
    }
    if (signals.when(signals.changed("parts_sent", parts_sent())))
        signals.value("part", part_bits, geometry_.offered.tag.part);
    Parts tests_left = 0;
    for (const PartSender<TestOperands>& branch : tests_)
        tests_left = static_cast<Parts>(tests_left | branch.left);
    signals.value("geometry_left", 9, geometry_.left);
    signals.value("tests_left", 9, tests_left);
    signals.value("host_triangles", 32, host_triangles_);
    signals.value("queue_triangles", 32, queue_triangles_);
}

}  // namespace tessera
