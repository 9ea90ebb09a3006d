#include "modules/memories/table_cache.h"

#include <algorithm>
#include <cstring>

#include "modules/stage/signals.h"

namespace tessera {

TableCache::TableCache(const sc_core::sc_module_name& name, CycleScheduler& clock, const datapath::TableLayout& layout,
                       const MemoryTiming& timing, const StallParameters& stalls)
    : TableCache(name, clock, layout, timing, stalls, CacheShape(timing.cache, layout)) {}

TableCache::TableCache(const sc_core::sc_module_name& name, CycleScheduler& clock, const datapath::TableLayout& layout,
                       const MemoryTiming& timing, const StallParameters& stalls, const CacheShape& shape)
    : MemoryServer(name, clock, timing.buffer, stalls),
      table("table", shape.line_bytes, false),
      base_(layout.base),
      line_bytes_(shape.line_bytes),
      cache_(shape.sets, shape.ways, shape.line_bytes),
      ports_(timing, layout),
      gathers_(timing.cache.fills),
      to_fetch_(timing.cache.fills),
      on_their_way_(timing.cache.fills) {
    table.clocked_by(clock, *this, timing.cache.fills, 1);
}

/// Whether some entries of the newest request have yet to be looked up.
bool TableCache::looking_up() const {
    return !gathers_.empty() && gathers_.back().looked_up < gathers_.back().request->count;
}

std::uint64_t TableCache::ready(const MemoryRequest&) const {
    return gathers_.full() || looking_up() ? ~std::uint64_t{0} : 0;
}

std::uint64_t TableCache::serve(MemoryRequest& request, std::uint64_t cycle) {
    if (request.command != tlm::TLM_READ_COMMAND) {
        request.response = tlm::TLM_COMMAND_ERROR_RESPONSE;
        return cycle;
    }
    request.response = tlm::TLM_OK_RESPONSE;
    gathers_.push({&request, 0, 0, false});
    look_up();
    Gather& gather = gathers_.back();
    if (!gather.complete())
        return ~std::uint64_t{0};
    gather.answered = true;
    drop_answered();
    return ports_.serve(request.address.data(), request.count, cycle);
}

void TableCache::take_entry(Gather& gather, unsigned entry, const LineCache::Line& line) {
    const MemoryRequest& request = *gather.request;
    const std::uint64_t place = request.address[entry] - base_ - line.number * line_bytes_;
    std::memcpy(request.entry(entry), &line.data[place], request.entry_bytes);
    gather.come |= 1u << entry;
}

/// Continues with the newest request, as far as fills can begin.
void TableCache::look_up() {
    while (looking_up()) {
        Gather& gather = gathers_.back();
        const std::uint64_t number = line_number(gather.request->address[gather.looked_up]);
        const LineCache::Line* line = cache_.find(number);
        if (line == nullptr) {
            if (on_their_way_.full())
                return;
            LineCache::Line* const begun = cache_.allocate(number);
            if (begun == nullptr)
                return;
            on_their_way_.push(begun);
            to_fetch_.push(number);
        } else {
            ++hits_;
            if (line->state == LineCache::State::present)
                take_entry(gather, gather.looked_up, *line);
        }
        ++gather.looked_up;
    }
}

void TableCache::take_fills(std::uint64_t cycle) {
    while (table.answered()) {
        LineCache::Line& line = *on_their_way_.front();
        std::memcpy(line.data.data(), table.answer(), line_bytes_);
        line.state = LineCache::State::present;
        on_their_way_.pop();
        table.pop_answer();
        for (std::size_t k = 0; k < gathers_.size(); ++k) {
            Gather& gather = gathers_.at(k);
            if (gather.answered)
                continue;
            for (unsigned entry = 0; entry < gather.looked_up; ++entry)
                if ((gather.come >> entry & 1u) == 0 && line_number(gather.request->address[entry]) == line.number)
                    take_entry(gather, entry, line);
        }
        look_up();
    }
    for (std::size_t k = 0; k < gathers_.size(); ++k) {
        Gather& gather = gathers_.at(k);
        if (gather.answered || !gather.complete())
            continue;
        gather.answered = true;
        finish(*gather.request, ports_.serve(gather.request->address.data(), gather.request->count, cycle));
    }
    drop_answered();
}

void TableCache::drop_answered() {
    while (!gathers_.empty() && gathers_.front().answered)
        gathers_.pop();
}

void TableCache::send_fills() {
    for (; !to_fetch_.empty() && table.may_request(); to_fetch_.pop())
        table.request(base_ + to_fetch_.front() * line_bytes_);
}

void TableCache::step() {
    const std::uint64_t cycle = now();
    take_fills(cycle);
    MemoryServer::step();
    send_fills();
    if (!gathers_.empty())
        activity_.set(cycle, State::waiting_for_memory, table.memory());
}

void TableCache::b_transport(int, MemoryRequest& request, sc_core::sc_time& delay) {
    table.socket->b_transport(request, delay);
}

bool TableCache::get_direct_mem_ptr(int, MemoryRequest& request, tlm::tlm_dmi& dmi) {
    return table.socket->get_direct_mem_ptr(request, dmi);
}

unsigned TableCache::transport_dbg(int, MemoryRequest& request) {
    if (request.command != tlm::TLM_WRITE_COMMAND)
        return table.socket->transport_dbg(request);
    return table.load(request.address[0], request.data, request.bytes()) ? request.bytes() : 0;
}

std::string TableCache::describe_contents() const {
    return listed(MemoryServer::describe_contents(),
                  count_of(on_their_way_.size(), "line") + (on_their_way_.empty() ? "" : " being fetched"));
}

void TableCache::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.value("requests", 32, activity_.items_in());
    signals.value("hits", 32, hits_);
    signals.value("fills", 32, fills());
    signals.value("lines_to_come", 16, on_their_way_.size());
    signals.flag("held_up", held_up());
    show_waiting(signals);
}

}  // namespace tessera
