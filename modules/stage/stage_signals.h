#pragma once
#include <cstdint>
#include <string>

#include "modules/sockets/memory_port.h"
#include "modules/stage/signals.h"
#include "modules/stage/stage.h"

namespace tessera {

// What a Stage shows of itself: its contents, its occupancy, its signals. Included by stage_steps.h only.

template <class In, class Out>
std::uint64_t Stage<In, Out>::occupied_cycles() const {
    return activity_.items_in() * timing_.interval / machinery_->servers;
}

/// The sum of a figure of each port.
template <class In, class Out>
template <class Figure>
std::uint64_t Stage<In, Out>::over_ports(Figure figure) const {
    std::uint64_t sum = 0;
    for (const MemoryPort* port : machinery_->ports)
        if (port != nullptr)
            sum += static_cast<std::uint64_t>(figure(*port));
    return sum;
}

template <class In, class Out>
std::string Stage<In, Out>::describe_contents() const {
    std::string text = count_of(machinery_->pipeline.size() + input_->size(), "item");
    if (over_ports([](const MemoryPort& port) { return port.on_offer(); }) > 0)
        text = listed(text, "a request that its memory does not accept");
    return listed(text, input_->holds_back() ? "one waiting at the input" : "");
}

/// Shows the item started last as `in` and the result of the item processed last as `out`; for a unit that reads, also
/// the last request and the numbers of requests and reads.
template <class In, class Out>
void Stage<In, Out>::trace_signals(Signals& signals) const {
    const Machinery& m = *machinery_;
    const auto show_result = [&](const typename Machinery::Slot& slot) {
        signals.item("out", slot.result);
        trace_processed(signals, slot.item, slot.result);
    };
    Unit::trace_signals(signals);
    signals.input(*input_);
    if (signals.when(signals.changed("started", activity_.items_in()) && !m.pipeline.empty())) {
        signals.item("in", m.pipeline.newest().item);
        if (!reads_tables())
            show_result(m.pipeline.newest());
    }
    if (!reads_tables())
        return;
    const std::uint64_t requests = over_ports([](const MemoryPort& port) { return port.requests(); });
    const std::uint64_t read = over_ports([](const MemoryPort& port) { return port.reads(); });
    const std::uint64_t under_way = over_ports([](const MemoryPort& port) { return port.requests_under_way(); });
    signals.pulse("request", requests);
    signals.value("requests", 32, requests);
    signals.value("reads", 32, read);
    signals.flag("request_held", over_ports([](const MemoryPort& port) { return port.on_offer(); }) > 0);
    signals.value("requests_under_way", 16, under_way);
    if (signals.when(signals.changed("asked", read) && under_way > 0))
        signals.value("address", 32, m.ports[m.reads.last_port()]->last_address());
    if (signals.when(signals.changed("processed", activity_.items_out() + m.waiting) && m.waiting > 0))
        show_result(m.waiting > 0 ? m.pipeline.at(m.waiting - 1) : m.pipeline.newest());
}

}  // namespace tessera
