#include "modules/units/triangle_queue.h"

#include <algorithm>
#include <string>

#include "modules/datapath/pack_triangle.h"
#include "modules/stage/signals.h"

namespace tessera {

namespace {
// Functional mode: triangles between two yields to the kernel, so that a stop takes effect.
constexpr unsigned triangles_between_waits = 1024;
}  // namespace

TriangleQueue::TriangleQueue(const sc_core::sc_module_name& name, const UnitContext& context)
    : Unit(name, context.clock),
      off_chip_memory("off_chip_memory",
                      datapath::packed_triangle_bytes(context.registers.formats) + datapath::packed_triangle_tag_bytes,
                      false),
      registers_(context.registers),
      design_(context.design.queue),
      timing_(context.timing().triangle_queue),
      latency_(clock_.period() * timing_.latency),
      record_bytes_(off_chip_memory.entry_bytes()),
      store_(design_.order),
      leaving_(timing_) {
    design_.watermark = std::max<std::size_t>(design_.watermark, 1);
    from_tessellation.register_b_transport<&TriangleQueue::b_transport>(*this);
    from_tessellation.clocked_by(clock_, *this, timing_.buffer, context.timing().stalls);
    to_get_triangle.clocked_by(context, *this);
    level.clocked_by(context, *this);
    off_chip_memory.clocked_by(clock_, *this, context.timing().off_chip_memory.buffer + 4, 1);
    SC_HAS_PROCESS(TriangleQueue);
    SC_THREAD(send_waiting);
    const std::uint64_t triangle = ItemWidths(context).of<datapath::Triangle>();
    area_.register_bits += timing_.buffer * triangle;
    area_.memory_bits = design_.capacity * triangle;
}

void TriangleQueue::b_transport(datapath::Triangle& triangle, sc_core::sc_time& delay) {
    store_.push(triangle);
    ++taken_;
    high_water_mark_ = std::max(high_water_mark_, store_.size());
    delay += latency_;
    tell_level(delay);
    if (!sending_)
        arrival_.notify(sc_core::SC_ZERO_TIME);
}

/// Functional mode.
void TriangleQueue::tell_level(sc_core::sc_time& delay) {
    if (told_.below_watermark == below_watermark())
        return;
    told_.below_watermark = below_watermark();
    QueueLevel told = told_;
    level.transport(told, delay);
}

void TriangleQueue::send_waiting() {
    for (;;) {
        if (store_.empty())
            wait(arrival_);
        sending_ = true;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        for (unsigned sent = 1; !store_.empty(); ++sent) {
            if (sent % triangles_between_waits == 0) {
                wait(delay);
                delay = sc_core::SC_ZERO_TIME;
            }
            datapath::Triangle triangle = store_.pop();
            to_get_triangle.transport(triangle, delay);
            tell_level(delay);
        }
        sending_ = false;
        emptied_.notify(sc_core::SC_ZERO_TIME);
        wait(delay);
    }
}

void TriangleQueue::level_changed(std::uint64_t cycle) {
    high_water_mark_ = std::max(high_water_mark_, waiting());
    on_chip_high_water_mark_ = std::max(on_chip_high_water_mark_, store_.size() + leaving_.size());
    history_.set(cycle, waiting());
}

void TriangleQueue::spill(const datapath::Triangle& triangle) {
    if (!datapath::pack_triangle(triangle, registers_.formats, off_chip_memory.entry_to_write()))
        SC_REPORT_ERROR("tessera/triangle_queue",
                        "a spilled triangle does not fit its format (generations beyond generation_bits?)");
    if (off_chip_ == 0)
        off_chip_head_ = 0;
    if (checks_off_chip_memory_) {
        const std::uint64_t place = (off_chip_head_ + off_chip_) % design_.off_chip_triangles;
        checksums_.resize(std::max<std::size_t>(checksums_.size(), place + 1));
        checksums_[place] = checksum(off_chip_memory.entry_to_write());
    }
    off_chip_memory.write(place_address(off_chip_head_ + off_chip_));
    ++off_chip_;
    ++spilled_;
}

/// FNV-1a.
std::uint32_t TriangleQueue::checksum(const unsigned char* record) const {
    std::uint32_t sum = 2166136261;
    for (std::size_t k = 0; k < record_bytes_; ++k)
        sum = (sum ^ record[k]) * 16777619;
    return sum;
}

void TriangleQueue::check_returned() {
    const std::uint64_t expected = returning_.front();
    returning_.pop_front();
    if (checksum(off_chip_memory.answer()) != expected)
        SC_REPORT_ERROR("tessera/triangle_queue",
                        (std::string(off_chip_memory.socket.name()) +
                         ": the memory that this port reads no longer holds a triangle that was written to it: give "
                         "each machine a memory, or addresses, of its own")
                            .c_str());
}

/// Returns false if there is no place for the triangle at present.
bool TriangleQueue::put(const datapath::Triangle& triangle) {
    const bool fifo = design_.order == TriangleOrder::fifo;
    if (on_chip_room() && (!fifo || (off_chip_ == 0 && refills_ == 0))) {
        store_.push(triangle);
        return true;
    }
    switch (design_.overflow) {
        case QueueOverflow::error:
            overflowed_ = true;
            clock_.halt();
            return false;
        case QueueOverflow::stall: return false;
        case QueueOverflow::spill: break;
    }
    if (off_chip_ == design_.off_chip_triangles) {
        off_chip_memory_full_ = true;
        clock_.halt();
        return false;
    }
    if (!off_chip_memory.may_request())
        return false;
    if (fifo) {
        spill(triangle);
        return true;
    }
    if (refills_ > 0)
        return false;  // returning triangles are older than anything here
    spill(store_.pop_oldest());
    store_.push(triangle);
    return true;
}

void TriangleQueue::take_back() {
    while (off_chip_memory.answered()) {
        if (off_chip_memory.answer_is_read()) {
            if (checks_off_chip_memory_)
                check_returned();
            const datapath::Triangle triangle = datapath::unpack_triangle(off_chip_memory.answer(), registers_.formats);
            if (design_.order == TriangleOrder::fifo)
                store_.push(triangle);
            else
                store_.push_oldest(triangle);
            --refills_;
            ++refilled_;
            on_chip_high_water_mark_ = std::max(on_chip_high_water_mark_, store_.size() + leaving_.size());
        }
        off_chip_memory.pop_answer();
    }
}

void TriangleQueue::refill() {
    const bool fifo = design_.order == TriangleOrder::fifo;
    while (off_chip_ > 0 && off_chip_memory.may_request() &&
           (fifo ? on_chip_room() : store_.size() + refills_ <= design_.capacity / 2)) {
        --off_chip_;
        const std::uint64_t place = fifo ? off_chip_head_++ : off_chip_head_ + off_chip_;
        if (checks_off_chip_memory_)
            returning_.push_back(checksums_[place % design_.off_chip_triangles]);
        off_chip_memory.request(place_address(place));
        ++refills_;
    }
}

void TriangleQueue::step() {
    const std::uint64_t cycle = now();
    take_back();
    for (bool changed = true; changed;) {
        changed = false;
        while (leaving_.front_finished(cycle) && to_get_triangle.deliver(leaving_.front())) {
            leaving_.pop();
            activity_.item_out(cycle);
            changed = true;
        }
        if (!from_tessellation.empty() && cycle >= next_in_ && put(from_tessellation.front())) {
            from_tessellation.pop();
            ++taken_;
            activity_.item_in(cycle);
            next_in_ = cycle + timing_.interval;
            changed = true;
        }
        if (!store_.empty() && leaving_.may_start(cycle)) {
            leaving_.start(cycle) = store_.pop();
            changed = true;
        }
        refill();
        if (changed)
            level_changed(cycle);
    }
    if (told_.below_watermark != below_watermark() && level.free()) {
        told_.below_watermark = below_watermark();
        level.send(told_);
    }
    if (!to_get_triangle.free())
        activity_.set(cycle, State::blocked, to_get_triangle.consumer());
    else if (!leaving_.empty() || !store_.empty())
        activity_.set(cycle, State::busy);
    else if (refills_ > 0 || off_chip_ > 0)
        activity_.set(cycle, State::waiting_for_memory, off_chip_memory.memory());
    else
        activity_.set(cycle, State::starved);
    wake_at(leaving_.next_finished(cycle));
    if (!store_.empty())
        wake_at(leaving_.next_start(cycle));
    if (!from_tessellation.empty() && next_in_ > cycle)
        wake_at(next_in_);
}

std::string TriangleQueue::describe_contents() const {
    std::string text = count_of(waiting(), "triangle");
    if (off_chip_ > 0)
        text += ", " + std::to_string(off_chip_) + " of them off chip";
    if (!leaving_.empty())
        text += ", " + std::to_string(leaving_.size()) + " of them leaving";
    if (from_tessellation.empty())
        return text;
    const std::string capacity = design_.capacity == 0 ? "" : " (capacity " + std::to_string(design_.capacity) + ")";
    return listed(text, "no room for the next" + capacity, "; ");
}

/// Shows the levels, spills and refills, and the triangle last read from the store.
void TriangleQueue::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.input(from_tessellation);
    signals.value("level", 32, waiting());
    signals.value("on_chip", 32, store_.size());
    signals.value("off_chip", 32, off_chip_);
    signals.value("coming_back", 16, refills_);
    signals.flag("takes_host_triangles", below_watermark());
    if (signals.when(signals.changed("left_store", activity_.items_out() + leaving_.size()))) {
        signals.value("base", 32, leaving_.newest().base);
        signals.flag("finished", leaving_.newest().finished);
    }
    signals.pulse("spill", spilled_);
    signals.pulse("refill", refilled_);
    signals.flag("request_held", off_chip_memory.on_offer());
    signals.value("requests_under_way", 16, off_chip_memory.requests_under_way());
}

}  // namespace tessera
