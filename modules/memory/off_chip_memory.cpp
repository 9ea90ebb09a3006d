#include "modules/memory/off_chip_memory.h"

#include <algorithm>
#include <cstring>

#include "modules/stream/stream.h"
#include "modules/unit/signals.h"

namespace tessera {

OffChipMemory::OffChipMemory(const sc_core::sc_module_name& name, Clock& clock, const OffChipTiming& timing,
                             const StallParameters& stalls, std::uint64_t size, unsigned uncounted)
    : Unit(name, clock),
      timing_(timing),
      size_(size),
      uncounted_(uncounted),
      stalls_(stalls, this->name()),
      queue_(timing.buffer),
      answer_ring_(16) {
    socket.register_nb_transport_fw(this, &OffChipMemory::nb_transport_fw);
}

tlm::tlm_sync_enum OffChipMemory::nb_transport_fw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                                  sc_core::sc_time& delay) {
    if (phase != tlm::BEGIN_REQ)
        stream_protocol_error(socket.name(), "a phase other than BEGIN_REQ", &clock_);
    if (at_the_door_ != nullptr)
        stream_protocol_error(socket.name(), "BEGIN_REQ before END_REQ of the request before", &clock_);
    const std::uint64_t wait = stalls_.next() + clock_.cycles(delay);
    const std::uint64_t cycle = now();
    activity_.item_in(cycle);
    payload.acquire();
    clock_.wake_at(*this, cycle + wait);
    if (wait == 0 && queued_ < queue_.size()) {
        queue_[(queue_first_ + queued_++) % queue_.size()] = &payload;
        phase = tlm::END_REQ;
        return tlm::TLM_UPDATED;
    }
    at_the_door_ = &payload;
    door_opens_ = cycle + wait;
    return tlm::TLM_ACCEPTED;
}

void OffChipMemory::admit(std::uint64_t cycle) {
    if (at_the_door_ == nullptr || queued_ == queue_.size() || door_opens_ > cycle)
        return;
    tlm::tlm_generic_payload& payload = *at_the_door_;
    at_the_door_ = nullptr;
    queue_[(queue_first_ + queued_++) % queue_.size()] = &payload;
    tlm::tlm_phase phase = tlm::END_REQ;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    socket->nb_transport_bw(payload, phase, delay);
}

void OffChipMemory::access(tlm::tlm_generic_payload& payload) {
    const std::uint64_t address = payload.get_address();
    const unsigned length = payload.get_data_length();
    const unsigned counted = length > uncounted_ ? length - uncounted_ : length;
    if (address > size_ || length > size_ - address) {
        payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
        return;
    }
    if (payload.is_write()) {
        if (storage_.size() < address + length)
            storage_.resize(
                std::max<std::size_t>(address + length, std::min<std::size_t>(2 * storage_.size(), size_)));
        std::memcpy(&storage_[address], payload.get_data_ptr(), length);
        bytes_written_ += counted;
    } else if (payload.is_read()) {
        std::memset(payload.get_data_ptr(), 0, length);
        if (address < storage_.size())
            std::memcpy(payload.get_data_ptr(), &storage_[address],
                        std::min<std::size_t>(length, storage_.size() - address));
        bytes_read_ += counted;
    } else {
        payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
        return;
    }
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
}

void OffChipMemory::serve(tlm::tlm_generic_payload& payload, std::uint64_t cycle) {
    const unsigned length = payload.get_data_length();
    const unsigned counted = length > uncounted_ ? length - uncounted_ : length;
    const std::uint64_t taken = (counted + timing_.bandwidth - 1) / timing_.bandwidth;
    channel_free_ = cycle + taken;
    channel_cycles_ += taken;
    access(payload);
    last_address_ = payload.get_address();
    last_is_write_ = payload.is_write();
    if (answers_ == answer_ring_.size()) {
        std::rotate(answer_ring_.begin(), answer_ring_.begin() + static_cast<std::ptrdiff_t>(answer_first_),
                    answer_ring_.end());
        answer_first_ = 0;
        answer_ring_.resize(2 * answer_ring_.size());
    }
    answer_ring_[(answer_first_ + answers_++) % answer_ring_.size()] = {&payload,
                                                                        channel_free_ + timing_.latency};
}

void OffChipMemory::step() {
    const std::uint64_t cycle = now();
    admit(cycle);
    while (queued_ > 0 && channel_free_ <= cycle) {
        tlm::tlm_generic_payload& payload = *queue_[queue_first_];
        queue_first_ = queue_first_ + 1 == queue_.size() ? 0 : queue_first_ + 1;
        --queued_;
        serve(payload, cycle);
        admit(cycle);
    }
    while (answers_ > 0 && answer_ring_[answer_first_].answer_at <= cycle) {
        tlm::tlm_generic_payload& payload = *answer_ring_[answer_first_].payload;
        answer_first_ = answer_first_ + 1 == answer_ring_.size() ? 0 : answer_first_ + 1;
        --answers_;
        activity_.item_out(cycle);
        tlm::tlm_phase phase = tlm::BEGIN_RESP;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        if (socket->nb_transport_bw(payload, phase, delay) != tlm::TLM_COMPLETED)
            stream_protocol_error(socket.name(), "BEGIN_RESP was not completed at once", &clock_);
        payload.release();
    }
    activity_.set(cycle, channel_free_ > cycle ? State::busy : State::starved);
    if (channel_free_ > cycle)
        wake_at(channel_free_);
    if (answers_ > 0)
        wake_at(answer_ring_[answer_first_].answer_at);
}

/// Shows the request served last.
void OffChipMemory::show(Signals& signals) const {
    Unit::show(signals);
    signals.pulse("served", channel_cycles_);
    signals.value("requests", 32, activity_.items_in());
    signals.value("address", 32, last_address_);
    signals.flag("write", last_is_write_);
    signals.flag("stalled", at_the_door_ != nullptr);
    signals.value("queued", 16, queued_);
    signals.value("answers_due", 16, answers_);
    signals.value("bytes_written", 32, bytes_written_);
    signals.value("bytes_read", 32, bytes_read_);
}

}  // namespace tessera
