#include "modules/units/tessellation.h"

#include <algorithm>

#include "modules/datapath/tessellate.h"
#include "modules/unit/signals.h"

namespace tessera {

Tessellation::Tessellation(const sc_core::sc_module_name& name, Clock& clock,
                           const datapath::Registers& registers, const Timing& timing, PassPool& passes)
    : Unit(name, clock), registers_(registers), timing_(timing.tessellation), passes_(passes) {
    from_pass_or_tessellate.serve<&Tessellation::b_transport>(*this);
    from_pass_or_tessellate.clocked_by(clock, *this, timing_.buffer, timing.stalls);
    to_triangle_queue.clocked_by(clock, *this);
}

void Tessellation::b_transport(Work& work, sc_core::sc_time& delay) {
    delay += clock_.period() * timing_.latency;
    const int children =
        tessellate(*work.pass, registers_.triangulation, registers_.formats, saturations_,
                   [&](datapath::Triangle& child) { to_triangle_queue->b_transport(child, delay); });
    ++made_into_[static_cast<std::size_t>(children)];
}

void Tessellation::step() {
    const std::uint64_t cycle = now();
    for (;;) {
        while (sent_ < made_ && to_triangle_queue.free() && next_ <= cycle) {
            next_ = cycle + timing_.interval;
            to_triangle_queue.send(children_[sent_++]);
        }
        if (sent_ < made_ || !to_triangle_queue.free())
            break;
        if (made_ > 0) {
            made_ = sent_ = 0;
            activity_.item_out(cycle);
        }
        if (from_pass_or_tessellate.empty())
            break;
        Pass& pass = *from_pass_or_tessellate.front().pass;
        tessellate(pass, registers_.triangulation, registers_.formats, saturations_,
                   [&](const datapath::Triangle& child) { children_[made_++] = child; });
        ++made_into_[made_];
        number_ = pass.number;
        activity_.item_in(cycle);
        next_ = std::max(next_, cycle + timing_.latency);
        from_pass_or_tessellate.pop();
        passes_.give_back(pass);
    }
    if (!to_triangle_queue.free())
        activity_.set(cycle, State::blocked, to_triangle_queue.consumer());
    else
        activity_.set(cycle, made_ > 0 ? State::busy : State::starved);
    if (sent_ < made_ && next_ > cycle)
        wake_at(next_);
}

std::string Tessellation::holds() const {
    std::string text;
    if (made_ > 0)
        text = std::to_string(made_ - sent_ + (to_triangle_queue.free() ? 0u : 1u)) + " of " +
               std::to_string(made_) + " children of a triangle";
    return listed(text, from_pass_or_tessellate.empty() ? "" : "a triangle that waits");
}

void Tessellation::show(Signals& signals) const {
    Unit::show(signals);
    signals.input(from_pass_or_tessellate);
    signals.group(signals.changed(activity_.items_in()),
                  [&] { signals.value("base", 32, children_[0].base); });
    signals.value("children", 3, made_);
    signals.value("children_left", 3, made_ - sent_);
}

}  // namespace tessera
