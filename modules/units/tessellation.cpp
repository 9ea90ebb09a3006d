#include "modules/units/tessellation.h"

#include <algorithm>

#include "modules/datapath/tessellate.h"
#include "modules/stage/signals.h"

namespace tessera {

TessellatingUnit::TessellatingUnit(const sc_core::sc_module_name& name, const UnitContext& context)
    : Unit(name, context.clock), registers_(context.registers), timing_(context.timing().tessellation) {}

TessellatingUnit::~TessellatingUnit() = default;

Tessellation::Tessellation(const sc_core::sc_module_name& name, const UnitContext& context)
    : TessellatingUnit(name, context), latency_(clock_.period() * timing_.latency) {
    from_pass_or_tessellate.register_b_transport<&Tessellation::b_transport>(*this);
    from_pass_or_tessellate.clocked_by(clock_, *this, timing_.buffer, context.timing().stalls);
    to_triangle_queue.clocked_by(context, *this);
    area_.register_bits += (timing_.buffer + 1) * ItemWidths(context).of<DecidedTriangle>();
}

void Tessellation::b_transport(DecidedTriangle& decided, sc_core::sc_time& delay) {
    delay += latency_;
    const int children = tessellate(decided.pass, registers_.triangulation, registers_.formats, saturations_,
                                    [&](datapath::Triangle& child) { to_triangle_queue.transport(child, delay); });
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
        const DecidedTriangle& decided = from_pass_or_tessellate.front();
        tessellate(decided.pass, registers_.triangulation, registers_.formats, saturations_,
                   [&](const datapath::Triangle& child) { children_[made_++] = child; });
        ++made_into_[made_];
        activity_.item_in(cycle);
        next_ = std::max(next_, cycle + timing_.latency);
        from_pass_or_tessellate.pop();
    }
    if (!to_triangle_queue.free())
        activity_.set(cycle, State::blocked, to_triangle_queue.consumer());
    else
        activity_.set(cycle, made_ > 0 ? State::busy : State::starved);
    if (sent_ < made_ && next_ > cycle)
        wake_at(next_);
}

std::string Tessellation::describe_contents() const {
    std::string text;
    if (made_ > 0)
        text = std::to_string(made_ - sent_ + (to_triangle_queue.free() ? 0u : 1u)) + " of " + std::to_string(made_) +
               " children of a triangle";
    return listed(text, from_pass_or_tessellate.empty() ? "" : "a waiting triangle");
}

void Tessellation::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.input(from_pass_or_tessellate);
    if (signals.when(signals.changed("begun", activity_.items_in())))
        signals.value("base", 32, children_[0].base);
    signals.value("children", 3, made_);
    signals.value("children_left", 3, made_ - sent_);
}

}  // namespace tessera
