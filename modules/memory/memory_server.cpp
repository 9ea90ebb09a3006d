#include "modules/memory/memory_server.h"

#include "modules/stream/stream.h"
#include "modules/unit/signals.h"

namespace tessera {

MemoryServer::MemoryServer(const sc_core::sc_module_name& name, Clock& clock, unsigned buffer,
                           const StallParameters& stalls)
    : Unit(name, clock), stalls_(stalls, this->name()), queue_(buffer) {
    socket.register_nb_transport_fw(this, &MemoryServer::nb_transport_fw);
    socket.register_b_transport(this, &MemoryServer::b_transport);
    socket.register_get_direct_mem_ptr(this, &MemoryServer::get_direct_mem_ptr);
    socket.register_transport_dbg(this, &MemoryServer::transport_dbg);
}

std::string MemoryServer::holds() const {
    return listed(count_of(queue_.size() + answers_.size(), "request"),
                  waiting_ == 0   ? ""
                  : waiting_ == 1 ? "one at its door"
                                  : std::to_string(waiting_) + " at its doors");
}

tlm::tlm_sync_enum MemoryServer::nb_transport_fw(int id, Payload& payload, tlm::tlm_phase& phase,
                                                 sc_core::sc_time& delay) {
    if (phase != tlm::BEGIN_REQ)
        stream_protocol_error(socket.name(), "a phase other than BEGIN_REQ", &clock_);
    const auto initiator = static_cast<std::size_t>(id);
    if (held_back_.size() <= initiator)
        held_back_.resize(initiator + 1);
    if (!held_back_[initiator].empty())
        stream_protocol_error(socket.name(), "BEGIN_REQ before END_REQ of the request before", &clock_);
    const std::uint64_t cycle = now();
    const std::uint64_t wait = stalls_.next() + clock_.cycles(delay);
    activity_.item_in(cycle);
    payload.acquire();
    if (wait > 0 || !queue_.full())
        clock_.wake_at(*this, cycle + wait);
    else
        clock_.show(*this);
    if (wait == 0 && !queue_.full() && waiting_ == 0) {
        queue_.push({&payload, id});
        phase = tlm::END_REQ;
        return tlm::TLM_UPDATED;
    }
    held_back_[initiator].hold(payload, cycle + wait);
    ++waiting_;
    return tlm::TLM_ACCEPTED;
}

void MemoryServer::admit(std::uint64_t cycle) {
    for (std::size_t tries = 0; tries < held_back_.size() && !queue_.full(); ++tries) {
        const std::size_t initiator = turn_;
        turn_ = turn_ + 1 == held_back_.size() ? 0 : turn_ + 1;
        if (!held_back_[initiator].due(cycle))
            continue;
        Payload& payload = held_back_[initiator].take();
        --waiting_;
        queue_.push({&payload, static_cast<int>(initiator)});
        tlm::tlm_phase phase = tlm::END_REQ;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        socket[static_cast<int>(initiator)]->nb_transport_bw(payload, phase, delay);
    }
}

void MemoryServer::answer(const Request& request) {
    tlm::tlm_phase phase = tlm::BEGIN_RESP;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    if (socket[request.id]->nb_transport_bw(*request.payload, phase, delay) != tlm::TLM_COMPLETED)
        stream_protocol_error(socket.name(), "BEGIN_RESP was not completed at once", &clock_);
    request.payload->release();
}

void MemoryServer::step() {
    const std::uint64_t cycle = clock_.last_cycle();
    if (held_up_)
        cycles_held_up_ += cycle - held_up_since_;
    if (waiting_ > 0)
        admit(cycle);
    std::uint64_t next = 0;
    while (!queue_.empty() && (next = ready(*queue_.front().payload)) <= cycle) {
        Request request = queue_.front();
        queue_.pop();
        request.answer_at = serve(*request.payload, cycle);
        answers_.push_back(request);
        if (waiting_ > 0)
            admit(cycle);
    }
    held_up_ = !queue_.empty();
    held_up_since_ = cycle;
    while (!answers_.empty() && answers_.front().answer_at <= cycle) {
        const Request request = answers_.front();
        answers_.pop_front();
        activity_.item_out(cycle);
        answer(request);
    }
    activity_.set(cycle, busy(cycle) ? State::busy : State::starved);
    if (held_up_)
        wake_at(next);
    if (!answers_.empty())
        wake_at(answers_.front().answer_at);
}

unsigned MemoryServer::move(Storage& storage, Payload& payload) {
    const unsigned length = payload.get_data_length();
    if (!storage.covers(payload.get_address(), length))
        return 0;
    if (payload.is_write())
        storage.write(payload.get_address(), payload.get_data_ptr(), length);
    else if (payload.is_read())
        storage.read(payload.get_address(), payload.get_data_ptr(), length);
    else
        return 0;
    return length;
}

void MemoryServer::show_waiting(Signals& signals) const {
    signals.flag("stalled", waiting_ > 0);
    signals.value("queued", 16, queue_.size());
    signals.value("answers_due", 16, answers_.size());
}

}  // namespace tessera
