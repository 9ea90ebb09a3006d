#include "modules/memory/table_memory.h"

#include <algorithm>
#include <cstring>

#include "modules/stream/stream.h"
#include "modules/unit/signals.h"

namespace tessera {

namespace {

/// Index modulo a ring's size, for less than twice that.
std::size_t place_in(std::size_t ring_size, std::size_t index) {
    return index < ring_size ? index : index - ring_size;
}

/// memcpy of a table's entry, whose usual sizes the compiler makes single moves of.
void copy_entry(unsigned char* to, const unsigned char* from, unsigned bytes) {
    switch (bytes) {
        case 2:
            std::memcpy(to, from, 2);
            break;
        case 4:
            std::memcpy(to, from, 4);
            break;
        case 6:
            std::memcpy(to, from, 6);
            break;
        default:
            std::memcpy(to, from, bytes);
    }
}

}  // namespace

TableMemory::TableMemory(const sc_core::sc_module_name& name, Clock& clock,
                         const datapath::TableLayout& layout, const MemoryTiming& timing,
                         const StallParameters& stalls)
    : Unit(name, clock),
      layout_(layout),
      timing_(timing),
      slots_per_entry_(timing.width == 0 ? 1 : (layout.entry_bytes + timing.width - 1) / timing.width),
      storage_(layout.bytes()),
      stalls_(stalls, this->name()),
      queue_(timing.buffer),
      one_by_one_(timing.banks == 1 && slots_per_entry_ == 1),
      port_free_(std::size_t{timing.banks} * timing.ports, 0),
      bank_slots_(timing.banks, 0),
      answer_ring_(16) {
    socket.register_b_transport(this, &TableMemory::b_transport);
    socket.register_nb_transport_fw(this, &TableMemory::nb_transport_fw);
    socket.register_get_direct_mem_ptr(this, &TableMemory::get_direct_mem_ptr);
    socket.register_transport_dbg(this, &TableMemory::transport_dbg);
}

bool TableMemory::covers(std::uint64_t address, std::uint64_t length) const {
    return length <= storage_.size() && address - layout_.base <= storage_.size() - length;
}

void TableMemory::read(tlm::tlm_generic_payload& payload, const GatherExtension* gather) {
    const unsigned length = payload.get_data_length();
    if (payload.get_command() != tlm::TLM_READ_COMMAND) {
        payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
        return;
    }
    if (payload.get_byte_enable_ptr() != nullptr) {
        payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
        return;
    }
    if (payload.get_streaming_width() < length) {
        payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
        return;
    }
    const unsigned count = gather == nullptr ? 1 : gather->count;
    const unsigned each = length / count;
    unsigned char* data = payload.get_data_ptr();
    const std::uint64_t own_address = payload.get_address();
    const std::uint64_t* const addresses = gather == nullptr ? &own_address : gather->address.data();
    for (unsigned k = 0; k < count; ++k) {
        if (!covers(addresses[k], each)) {
            payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
            return;
        }
        copy_entry(data + std::size_t{k} * each, &storage_[addresses[k] - layout_.base], each);
    }
    transactions_ += count;
    payload.set_dmi_allowed(true);
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
}

void TableMemory::b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
    read(payload, payload.get_extension<GatherExtension>());
    if (payload.is_response_ok())
        delay += clock_.period() * timing_.latency;
}

tlm::tlm_sync_enum TableMemory::nb_transport_fw(int id, tlm::tlm_generic_payload& payload,
                                                tlm::tlm_phase& phase, sc_core::sc_time& delay) {
    if (phase != tlm::BEGIN_REQ)
        stream_protocol_error(socket.name(), "a phase other than BEGIN_REQ", &clock_);
    const auto door = static_cast<std::size_t>(id);
    if (at_the_door_.size() <= door) {
        at_the_door_.resize(door + 1);
        door_opens_.resize(door + 1);
    }
    if (at_the_door_[door].payload != nullptr)
        stream_protocol_error(socket.name(), "BEGIN_REQ before END_REQ of the request before", &clock_);
    const std::uint64_t cycle = now();
    const std::uint64_t wait = stalls_.next() + clock_.cycles(delay);
    activity_.item_in(cycle);
    payload.acquire();
    if (wait > 0 || queued_ < timing_.buffer)
        clock_.wake_at(*this, cycle + wait);
    else
        clock_.show(*this);
    if (wait == 0 && queued_ < timing_.buffer && waiting_at_doors_ == 0) {
        queue_[place_in(timing_.buffer, queue_first_ + queued_++)] = {
            &payload, payload.get_extension<GatherExtension>(), id, 0};
        phase = tlm::END_REQ;
        return tlm::TLM_UPDATED;
    }
    at_the_door_[door] = {&payload, payload.get_extension<GatherExtension>(), id, 0};
    door_opens_[door] = cycle + wait;
    ++waiting_at_doors_;
    return tlm::TLM_ACCEPTED;
}

void TableMemory::admit(std::uint64_t cycle) {
    for (std::size_t tries = 0; tries < at_the_door_.size() && queued_ < timing_.buffer; ++tries) {
        const std::size_t door = door_turn_;
        door_turn_ = door_turn_ + 1 == at_the_door_.size() ? 0 : door_turn_ + 1;
        Request& request = at_the_door_[door];
        if (request.payload == nullptr || door_opens_[door] > cycle)
            continue;
        queue_[place_in(timing_.buffer, queue_first_ + queued_++)] = request;
        tlm::tlm_generic_payload& payload = *request.payload;
        request.payload = nullptr;
        --waiting_at_doors_;
        tlm::tlm_phase phase = tlm::END_REQ;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        socket[static_cast<int>(door)]->nb_transport_bw(payload, phase, delay);
    }
}

/// The bank's port that is free first.
std::uint64_t* TableMemory::free_port(std::size_t bank) {
    const auto first = port_free_.begin() + static_cast<std::ptrdiff_t>(bank * timing_.ports);
    return &*std::min_element(first, first + timing_.ports);
}

/// The first cycle, later ones excepted, in which the request can be served.
std::uint64_t TableMemory::when_served(const Request& request) {
    if (one_by_one_)
        return timing_.ports == 1 ? next_slot_ : next_slot_ / timing_.ports;
    std::uint64_t when = 0;
    const unsigned count = request.gather == nullptr ? 1 : request.gather->count;
    for (unsigned k = 0; k < count; ++k)
        when = std::max(when, *free_port(bank_of(request.gather == nullptr ? request.payload->get_address()
                                                                           : request.gather->address[k])));
    return when;
}

/// Returns the cycle of the last port slot the request's entries take.
std::uint64_t TableMemory::take_slots(const tlm::tlm_generic_payload& payload, const GatherExtension* gather,
                                      unsigned count, std::uint64_t cycle) {
    slots_taken_ += std::uint64_t{count} * slots_per_entry_;
    if (one_by_one_) {
        next_slot_ = std::max(next_slot_, cycle * timing_.ports) + count;
        return timing_.ports == 1 ? next_slot_ - 1 : (next_slot_ - 1) / timing_.ports;
    }
    std::uint64_t last = cycle;
    for (unsigned k = 0; k < count; ++k) {
        const std::size_t bank = bank_of(gather == nullptr ? payload.get_address() : gather->address[k]);
        std::uint64_t* const free = free_port(bank);
        *free = std::max(*free, cycle) + slots_per_entry_;
        bank_slots_[bank] += slots_per_entry_;
        last = std::max(last, *free - 1);
    }
    return last;
}

std::uint64_t TableMemory::occupied_cycles() const {
    const std::uint64_t slots =
        one_by_one_ ? slots_taken_ : *std::max_element(bank_slots_.begin(), bank_slots_.end());
    return std::max(slots / timing_.ports, cycles_held_up_);
}

void TableMemory::serve(const Request& request, std::uint64_t cycle) {
    tlm::tlm_generic_payload& payload = *request.payload;
    const GatherExtension* gather = request.gather;
    const unsigned count = gather == nullptr ? 1 : gather->count;
    const std::uint64_t last_slot_cycle = take_slots(payload, gather, count, cycle);
    last_address_ = payload.get_address();
    read(payload, gather);
    if (answers_ == answer_ring_.size()) {
        std::rotate(answer_ring_.begin(), answer_ring_.begin() + static_cast<std::ptrdiff_t>(answer_first_),
                    answer_ring_.end());
        answer_first_ = 0;
        answer_ring_.resize(2 * answer_ring_.size());
    }
    Request& answer = answer_ring_[place_in(answer_ring_.size(), answer_first_ + answers_++)];
    answer = request;
    answer.answer_at = last_slot_cycle + timing_.latency;
}

void TableMemory::step() {
    const std::uint64_t cycle = clock_.last_cycle();
    if (held_up_)
        cycles_held_up_ += cycle - held_up_since_;
    if (waiting_at_doors_ > 0)
        admit(cycle);
    std::uint64_t next = 0;
    while (queued_ > 0 && (next = when_served(queue_[queue_first_])) <= cycle) {
        const Request request = queue_[queue_first_];
        queue_first_ = queue_first_ + 1 == timing_.buffer ? 0 : queue_first_ + 1;
        --queued_;
        serve(request, cycle);
        if (waiting_at_doors_ > 0)
            admit(cycle);
    }
    held_up_ = queued_ > 0;
    held_up_since_ = cycle;
    while (answers_ > 0 && answer_ring_[answer_first_].answer_at <= cycle) {
        const Request answer = answer_ring_[answer_first_];
        answer_first_ = answer_first_ + 1 == answer_ring_.size() ? 0 : answer_first_ + 1;
        --answers_;
        activity_.item_out(cycle);
        tlm::tlm_phase phase = tlm::BEGIN_RESP;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        if (socket[answer.id]->nb_transport_bw(*answer.payload, phase, delay) != tlm::TLM_COMPLETED)
            stream_protocol_error(socket.name(), "BEGIN_RESP was not completed at once", &clock_);
        answer.payload->release();
    }
    activity_.set(cycle, answers_ > 0 ? State::busy : State::starved);
    if (held_up_)
        wake_at(next);
    if (answers_ > 0)
        wake_at(answer_ring_[answer_first_].answer_at);
}

bool TableMemory::get_direct_mem_ptr(int, tlm::tlm_generic_payload& payload, tlm::tlm_dmi& dmi) {
    if (payload.get_command() != tlm::TLM_READ_COMMAND || !covers(payload.get_address(), 1))
        return false;
    dmi.set_start_address(layout_.base);
    dmi.set_end_address(layout_.base + layout_.bytes() - 1);
    dmi.set_dmi_ptr(storage_.data());
    dmi.set_read_latency(clock_.period() * timing_.latency);
    dmi.allow_read();
    return true;
}

unsigned TableMemory::transport_dbg(int, tlm::tlm_generic_payload& payload) {
    if (!covers(payload.get_address(), payload.get_data_length()))
        return 0;
    unsigned char* const place = &storage_[payload.get_address() - layout_.base];
    if (payload.get_command() == tlm::TLM_WRITE_COMMAND)
        std::memcpy(place, payload.get_data_ptr(), payload.get_data_length());
    else if (payload.get_command() == tlm::TLM_READ_COMMAND)
        std::memcpy(payload.get_data_ptr(), place, payload.get_data_length());
    else
        return 0;
    return payload.get_data_length();
}

/// Shows the request served last, of which data is the first entry, and how many requests have come and entries have
/// been read: several in a cycle, or in cycles that follow each other, are one pulse.
void TableMemory::show(Signals& signals) const {
    Unit::show(signals);
    signals.pulse("served", slots_taken_);
    signals.value("requests", 32, activity_.items_in());
    signals.value("reads", 32, transactions_);
    signals.group(signals.changed(slots_taken_) && signals.running(), [&] {
        // Answers leave the ring in order, so the newest stays where it is until the ring comes round.
        const Request& last =
            answer_ring_[(answer_first_ + answers_ + answer_ring_.size() - 1) % answer_ring_.size()];
        std::uint64_t entries = 0;
        std::uint64_t data = 0;
        if (last.payload != nullptr) {
            const GatherExtension* gather = last.payload->get_extension<GatherExtension>();
            entries = gather == nullptr ? 1 : gather->count;
            std::memcpy(&data, last.payload->get_data_ptr(),
                        std::min<std::size_t>(layout_.entry_bytes, sizeof data));
        }
        signals.value("address", 32, last_address_);
        signals.value("entries", 4, entries);
        signals.value("data", 64, data);
    });
    signals.flag("held_up", held_up_);
    signals.flag("stalled", waiting_at_doors_ > 0);
    signals.value("queued", 16, queued_);
    signals.value("answers_due", 16, answers_);
}

}  // namespace tessera
