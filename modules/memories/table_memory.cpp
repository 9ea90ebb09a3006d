#include "modules/memories/table_memory.h"

#include <algorithm>
#include <utility>

#include "modules/memories/line_cache.h"
#include "modules/stage/signals.h"

namespace tessera {
namespace {

/// The entries of a table, or of its cache, once for each port.
std::uint64_t copied_entries(const datapath::TableLayout& layout, const MemoryTiming& timing) {
    const std::uint64_t entries = timing.cache.bytes > 0 ? CacheShape(timing.cache, layout).bytes() / layout.entry_bytes
                                                         : std::uint64_t{layout.rows} * layout.columns;
    return timing.ports * entries;
}

}  // namespace

TableMemory::TableMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, std::shared_ptr<Storage> storage,
                         const datapath::TableLayout& layout, const MemoryTiming& timing, const StallParameters& stalls,
                         Channel* off_chip)
    : MemoryServer(name, clock, timing.buffer, stalls),
      storage_(std::move(storage)),
      ports_(timing, layout),
      waiting_requests_(std::uint64_t{timing.buffer} + timing.window),
      copied_entries_(copied_entries(layout, timing)),
      address_bits_(static_cast<std::uint64_t>(datapath::bits_for(std::uint64_t{layout.rows} * layout.columns))),
      channel_(timing.cache.bytes == 0 ? nullptr : off_chip),
      may_be_prompt_(timing.cache.bytes == 0 && stalls.per_mille == 0),
      served_(timing.buffer) {}

TableMemory::TableMemory(const sc_core::sc_module_name& name, CycleScheduler& clock,
                         const datapath::TableLayout& layout, const MemoryTiming& timing, const StallParameters& stalls,
                         Channel* off_chip)
    : TableMemory(name, clock,
                  std::make_shared<Storage>(layout.base,
                                            layout.bytes() + (timing.cache.bytes == 0 ? 0 : timing.cache.line_bytes)),
                  layout, timing, stalls, off_chip) {
    storage_->all();
}

TableMemory::TableMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, const TableMemory& first_side,
                         const datapath::TableLayout& layout, const MemoryTiming& timing, const StallParameters& stalls)
    : TableMemory(name, clock, first_side.storage_, layout, timing, stalls, nullptr) {}

void TableMemory::set_area(int entry_bits, unsigned entries_read) {
    area_.register_bits = waiting_requests_ * entries_read * address_bits_;
    area_.memory_bits = copied_entries_ * static_cast<std::uint64_t>(entry_bits);
    area_.ports = ports_.slots_per_cycle();
}

void TableMemory::read(MemoryRequest& request) {
    access(*storage_, request, false);
    request.dmi_allowed = request.is_ok();
    if (request.is_ok())
        transactions_ += request.count;
}

std::uint64_t TableMemory::ready(const MemoryRequest& request) const {
    return channel_ != nullptr ? channel_->ready() : ports_.ready(request.address.data(), request.count);
}

std::uint64_t TableMemory::serve(MemoryRequest& request, std::uint64_t cycle) {
    read(request);
    last_address_ = request.address[0];
    last_entries_ = request.count;
    last_entry_bytes_ = request.entry_bytes;
    if (channel_ == nullptr)
        return ports_.serve(request.address.data(), request.count, cycle);
    const std::uint64_t answer_at = channel_->serve(request.bytes(), cycle);
    channel_cycles_ += channel_->ready() - cycle;
    return answer_at;
}

bool TableMemory::is_prompt() {
    return may_be_prompt_ && socket.size() == 1;
}

bool TableMemory::read_promptly(const std::uint64_t* addresses, unsigned count, unsigned entry_bytes,
                                std::uint64_t* entries, std::uint64_t offered, Times& times) {
    if (!storage_->read_entries(addresses, count, entry_bytes, entries))
        return false;
    transactions_ += count;
    times.accepted = std::max(offered, served_[oldest_served_]);
    const std::uint64_t first = std::max(times.accepted, last_served_);
    last_served_ = std::max(first, ports_.ready(addresses, count));
    count_held_up(last_served_ - first);
    served_[oldest_served_] = last_served_;
    oldest_served_ = oldest_served_ + 1 == served_.size() ? 0 : oldest_served_ + 1;
    times.answered = last_answer_ = std::max(last_answer_, ports_.serve(addresses, count, last_served_));
    while (!answers_due_.empty() && answers_due_.front() <= offered)
        answers_due_.pop();
    if (answers_due_.full())
        answers_due_.grow();
    if (last_answer_ > offered)
        answers_due_.push(last_answer_);
    activity_.item_through(offered, last_answer_, answers_due_.size());
    activity_.set_until(last_answer_, State::starved, last_served_, State::busy);
    return true;
}

void TableMemory::b_transport(int, MemoryRequest& request, sc_core::sc_time& delay) {
    read(request);
    if (request.is_ok())
        delay += clock_.period() * ports_.latency();
}

bool TableMemory::get_direct_mem_ptr(int, MemoryRequest& request, tlm::tlm_dmi& dmi) {
    if (request.command != tlm::TLM_READ_COMMAND || !storage_->covers(request.address[0], 1))
        return false;
    dmi.set_start_address(storage_->base());
    dmi.set_end_address(storage_->base() + storage_->size() - 1);
    dmi.set_dmi_ptr(storage_->all());
    dmi.set_read_latency(clock_.period() * ports_.latency());
    dmi.allow_read();
    return true;
}

/// Shows the request served last, with its first entry as data, and the numbers of requests received and entries read.
/// Several in one cycle, or in consecutive cycles, are one pulse.
void TableMemory::trace_signals(Signals& signals) const {
    Unit::trace_signals(signals);
    signals.pulse("served", slots_taken());
    signals.value("requests", 32, activity_.items_in());
    signals.value("reads", 32, transactions_);
    if (signals.when(signals.changed("slots_taken", slots_taken()) && signals.running())) {
        std::uint64_t data = 0;
        const std::size_t bytes = std::min<std::size_t>(last_entry_bytes_, sizeof data);
        if (storage_->covers(last_address_, bytes))
            storage_->read(last_address_, reinterpret_cast<unsigned char*>(&data), bytes);
        signals.value("address", 32, last_address_);
        signals.value("entries", 4, last_entries_);
        signals.value("data", 64, data);
    }
    signals.flag("held_up", held_up());
    show_waiting(signals);
}

}  // namespace tessera
