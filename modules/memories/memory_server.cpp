#include "modules/memories/memory_server.h"

#include "modules/sockets/stream.h"
#include "modules/stage/signals.h"

namespace tessera {

MemoryServer::MemoryServer(const sc_core::sc_module_name& name, CycleScheduler& clock, unsigned buffer,
                           const StallParameters& stalls)
    : Unit(name, clock), stalls_(stalls, this->name()), queue_(buffer) {
    socket.register_nb_transport_fw(this, &MemoryServer::nb_transport_fw);
    socket.register_b_transport(this, &MemoryServer::b_transport);
    socket.register_get_direct_mem_ptr(this, &MemoryServer::get_direct_mem_ptr);
    socket.register_transport_dbg(this, &MemoryServer::transport_dbg);
    host.register_transport_dbg(this, &MemoryServer::host_transport_dbg);
}

MemoryServer::~MemoryServer() = default;

std::string MemoryServer::describe_contents() const {
    return listed(count_of(queue_.size() + answers_.size(), "request"),
                  waiting_ == 0   ? ""
                  : waiting_ == 1 ? "one waiting at the input"
                                  : std::to_string(waiting_) + " waiting at the inputs");
}

tlm::tlm_sync_enum MemoryServer::nb_transport_fw(int id, MemoryRequest& request, tlm::tlm_phase& phase,
                                                 sc_core::sc_time& delay) {
    if (phase != tlm::BEGIN_REQ)
        stream_protocol_error(socket.name(), "a phase other than BEGIN_REQ", &clock_);
    const auto port = static_cast<std::size_t>(id);
    if (held_back_.size() <= port)
        held_back_.resize(port + 1);
    if (!held_back_[port].empty())
        stream_protocol_error(socket.name(), "BEGIN_REQ before END_REQ of the previous request", &clock_);
    const std::uint64_t cycle = now();
    const std::uint64_t wait = stalls_.next() + clock_.cycles(delay);
    activity_.item_in(cycle);
    if (wait > 0 || !queue_.full())
        clock_.wake_at(*this, cycle + wait);
    else
        clock_.wake_if_observed(*this);
    if (wait == 0 && !queue_.full() && waiting_ == 0) {
        queue_.push({&request, id});
        phase = tlm::END_REQ;
        return tlm::TLM_UPDATED;
    }
    held_back_[port].hold(request, cycle + wait);
    ++waiting_;
    return tlm::TLM_ACCEPTED;
}

void MemoryServer::admit(std::uint64_t cycle) {
    for (std::size_t tries = 0; tries < held_back_.size() && !queue_.full(); ++tries) {
        const std::size_t port = turn_;
        turn_ = turn_ + 1 == held_back_.size() ? 0 : turn_ + 1;
        if (!held_back_[port].due(cycle))
            continue;
        MemoryRequest& request = held_back_[port].take();
        --waiting_;
        queue_.push({&request, static_cast<int>(port)});
        tlm::tlm_phase phase = tlm::END_REQ;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        socket[static_cast<int>(port)]->nb_transport_bw(request, phase, delay);
    }
}

void MemoryServer::answer(const Served& served) {
    tlm::tlm_phase phase = tlm::BEGIN_RESP;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    if (socket[served.id]->nb_transport_bw(*served.request, phase, delay) != tlm::TLM_COMPLETED)
        stream_protocol_error(socket.name(), "BEGIN_RESP was not completed at once", &clock_);
}

void MemoryServer::finish(const MemoryRequest& request, std::uint64_t cycle) {
    std::size_t k = 0;
    while (answers_.at(k).request != &request)
        ++k;
    answers_.at(k).answer_at = cycle;
    wake_at(cycle);
}

void MemoryServer::step() {
    const std::uint64_t cycle = clock_.last_cycle();
    if (held_up_)
        cycles_held_up_ += cycle - held_up_since_;
    if (waiting_ > 0)
        admit(cycle);
    std::uint64_t next = 0;
    while (!queue_.empty() && (next = ready(*queue_.front().request)) <= cycle) {
        Served served = queue_.front();
        queue_.pop();
        served.answer_at = serve(*served.request, cycle);
        if (answers_.full())
            answers_.grow();
        answers_.push(served);
        if (waiting_ > 0)
            admit(cycle);
    }
    held_up_ = !queue_.empty();
    held_up_since_ = cycle;
    while (!answers_.empty() && answers_.front().answer_at <= cycle) {
        const Served served = answers_.front();
        answers_.pop();
        activity_.item_out(cycle);
        answer(served);
    }
    activity_.set(cycle, busy(cycle) ? State::busy : State::starved);
    if (held_up_)
        wake_at(next);
    if (!answers_.empty())
        wake_at(answers_.front().answer_at);
}

unsigned MemoryServer::move(Storage& storage, MemoryRequest& request) {
    const bool writes = request.command == tlm::TLM_WRITE_COMMAND;
    if (!writes && request.command != tlm::TLM_READ_COMMAND)
        return 0;
    // Copies: to the compiler the entries' bytes could be those of the request.
    const unsigned count = request.count, entry_bytes = request.entry_bytes;
    unsigned char* entry = request.data;
    if (!writes && storage.read_entries(request.address.data(), count, entry_bytes, entry))
        return count * entry_bytes;
    for (unsigned k = 0; k < count; ++k, entry += entry_bytes) {
        const std::uint64_t address = request.address[k];
        if (!storage.covers(address, entry_bytes))
            return 0;
        if (writes)
            storage.write(address, entry, entry_bytes);
        else
            storage.read(address, entry, entry_bytes);
    }
    return count * entry_bytes;
}

void MemoryServer::access(Storage& storage, MemoryRequest& request, bool may_write) {
    if (request.command != tlm::TLM_READ_COMMAND && !(may_write && request.command == tlm::TLM_WRITE_COMMAND))
        request.response = tlm::TLM_COMMAND_ERROR_RESPONSE;
    else if (move(storage, request) == 0)
        request.response = tlm::TLM_ADDRESS_ERROR_RESPONSE;
    else
        request.response = tlm::TLM_OK_RESPONSE;
}

unsigned MemoryServer::host_transport_dbg(tlm::tlm_generic_payload& payload) {
    if (no_reader_ && payload.is_write())
        SC_REPORT_ERROR("tessera/memory",
                        (std::string(name()) + ": no unit reads this memory, since a UnitFactory has "
                                               "joined their ports elsewhere: write by Machine::write_table()")
                            .c_str());
    MemoryRequest request{
        payload.get_command(), 1, payload.get_data_length(), {payload.get_address()}, payload.get_data_ptr()};
    return transport_dbg(0, request);
}

void MemoryServer::show_waiting(Signals& signals) const {
    signals.flag("stalled", waiting_ > 0);
    signals.value("queued", 16, queue_.size());
    signals.value("answers_due", 16, answers_.size());
}

}  // namespace tessera
