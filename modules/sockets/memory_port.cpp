#include "modules/sockets/memory_port.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "modules/sockets/stream.h"

namespace tessera {

MemoryPort::Socket::Socket(const char* name, const MemoryPort& its_port)
    : simple_initiator_socket(name), port(its_port) {}

MemoryPort::Socket::~Socket() = default;

MemoryPort::MemoryPort(const char* name, std::size_t entry_bytes, bool use_direct_memory)
    : socket(name, *this),
      entry_bytes_(static_cast<unsigned>(entry_bytes)),
      mask_(entry_bytes >= 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << (8 * entry_bytes)) - 1),
      use_direct_memory_(use_direct_memory) {
    socket.register_invalidate_direct_mem_ptr(this, &MemoryPort::invalidate_direct_mem_ptr);
    socket.register_nb_transport_bw(this, &MemoryPort::nb_transport_bw);
}

MemoryPort::~MemoryPort() = default;

void MemoryPort::check_response(const MemoryRequest& request) const {
    if (request.is_ok())
        return;
    tlm::tlm_generic_payload words;
    words.set_response_status(request.response);
    std::ostringstream message;
    message << socket.name() << ": " << (request.command == tlm::TLM_WRITE_COMMAND ? "write of " : "read of ")
            << request.bytes() << " bytes at address 0x" << std::hex << request.address[0] << " answered "
            << words.get_response_string();
    SC_REPORT_ERROR("tessera/memory", message.str().c_str());
}

void MemoryPort::check_contents(const MemoryRequest& request) const {
    for (unsigned k = 0; request.command == tlm::TLM_READ_COMMAND && k < request.count; ++k) {
        const std::uint64_t offset = request.address[k] - loaded_from_;
        if (offset >= loaded_.size())
            continue;
        const unsigned char* const entry = request.entry(k);
        const std::size_t count = std::min<std::size_t>(request.entry_bytes, loaded_.size() - offset);
        if (std::equal(entry, entry + count, loaded_.begin() + static_cast<std::ptrdiff_t>(offset)))
            continue;
        std::ostringstream message;
        message
            << socket.name()
            << ": the memory that this port reads answers with other bytes than were written to it by debug transport: "
               "lead debug accesses where transactions go, and give each machine and table a memory, or addresses, of "
               "its own; read at address 0x"
            << std::hex << request.address[k];
        SC_REPORT_ERROR("tessera/memory", message.str().c_str());
    }
}

void MemoryPort::read_by_transactions(const std::uint64_t* addresses, unsigned count, std::uint64_t* entries,
                                      sc_core::sc_time& delay) {
    for (unsigned k = 0; k < count; ++k) {
        ++reads_;
        unsigned char data[sizeof(std::uint64_t)] = {};
        MemoryRequest request{tlm::TLM_READ_COMMAND, 1, entry_bytes_, {addresses[k]}, data};
        const std::uint64_t watched = watch_ == nullptr ? 0 : watch_->begin(request.command, addresses[k], delay);
        socket->b_transport(request, delay);
        if (watch_ != nullptr)
            watch_->end(watched);
        check_response(request);
        if (compares_)
            check_contents(request);
        if (use_direct_memory_ && request.dmi_allowed && direct_bytes_ == 0)
            ask_for_direct_memory(request);
        entries[k] = 0;
        std::memcpy(&entries[k], data, entry_bytes_);
    }
}

void MemoryPort::ask_for_direct_memory(MemoryRequest& request) {
    tlm::tlm_dmi dmi;
    if (!socket->get_direct_mem_ptr(request, dmi) || !dmi.is_read_allowed())
        return;
    direct_ = dmi.get_dmi_ptr();
    direct_start_ = dmi.get_start_address();
    const std::uint64_t span = dmi.get_end_address() - dmi.get_start_address() + 1;
    direct_bytes_ = span >= sizeof(std::uint64_t) ? span - sizeof(std::uint64_t) + 1 : 0;
    for (std::size_t k = 1; k < direct_times_.size(); ++k)
        direct_times_[k] = direct_times_[k - 1] + dmi.get_read_latency();
}

void MemoryPort::clocked_by(CycleScheduler& clock, CycleProcess& unit, std::size_t most_under_way,
                            unsigned most_entries) {
    clock_ = &clock;
    unit_ = &unit;
    slots_ = Ring<Slot>(most_under_way);
    for (std::size_t k = 0; k < most_under_way; ++k)
        slots_.at(k).data.resize(std::size_t{most_entries} * entry_bytes_ + sizeof(std::uint64_t));
}

void MemoryPort::request(const std::uint64_t* addresses, unsigned count) {
    offer(tlm::TLM_READ_COMMAND, addresses, count);
    reads_ += count;
}

PromptMemory::Times MemoryPort::read_promptly(const std::uint64_t* addresses, unsigned count, std::uint64_t* entries,
                                              std::uint64_t offered) {
    ++requests_;
    reads_ += count;
    PromptMemory::Times times{};
    if (!prompt_->read_promptly(addresses, count, entry_bytes_, entries, offered, times))
        check_response(
            {tlm::TLM_READ_COMMAND, count, entry_bytes_, {addresses[0]}, nullptr, tlm::TLM_ADDRESS_ERROR_RESPONSE});
    return times;
}

void MemoryPort::write(std::uint64_t address) {
    offer(tlm::TLM_WRITE_COMMAND, &address, 1);
}

void MemoryPort::offer(tlm::tlm_command command, const std::uint64_t* addresses, unsigned count) {
    if (on_offer_)
        stream_protocol_error(socket.name(), "BEGIN_REQ before END_REQ of the previous request", clock_);
    ++requests_;
    Slot& slot = slots_.push();
    MemoryRequest& request = slot.request;
    request.command = command;
    request.count = count;
    request.entry_bytes = entry_bytes_;
    std::copy_n(addresses, count, request.address.begin());
    request.data = slot.data.data();
    request.response = tlm::TLM_INCOMPLETE_RESPONSE;
    if (watch_ != nullptr)
        slot.watched = watch_->begin(command, addresses[0], sc_core::SC_ZERO_TIME);
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    on_offer_ = true;
    const tlm::tlm_sync_enum status = socket->nb_transport_fw(request, phase, delay);
    if (status == tlm::TLM_ACCEPTED)
        return;
    const bool on_offer = std::exchange(on_offer_, false);
    if (status != tlm::TLM_UPDATED || phase != tlm::END_REQ)
        stream_protocol_error(socket.name(), "BEGIN_REQ was answered by neither END_REQ nor TLM_ACCEPTED", clock_);
    if (!on_offer)
        stream_protocol_error(socket.name(), "END_REQ returned for a request that was already accepted", clock_);
}

tlm::tlm_sync_enum MemoryPort::nb_transport_bw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay) {
    const std::uint64_t cycle = clock_->cycle() + clock_->cycles(delay);
    clock_->wake_at(*unit_, cycle);
    if (phase == tlm::END_REQ) {
        if (!on_offer_ || &slots_.back().request != &request)
            stream_protocol_error(socket.name(), "END_REQ for a request that is not pending", clock_);
        on_offer_ = false;
        return tlm::TLM_ACCEPTED;
    }
    if (phase != tlm::BEGIN_RESP)
        stream_protocol_error(socket.name(), "a phase that a memory must not send", clock_);
    if (answered_ == slots_.size())
        stream_protocol_error(socket.name(), "BEGIN_RESP for an unknown request", clock_);
    const bool taken = !on_offer_ || answered_ + 1 < slots_.size();
    if (&slots_.at(answered_).request != &request || !taken)
        stream_protocol_error(socket.name(), "BEGIN_RESP out of order or before END_REQ", clock_);
    check_response(request);
    if (watch_ != nullptr)
        watch_->end(slots_.at(answered_).watched);
    if (compares_)
        check_contents(request);
    ++answered_;
    return tlm::TLM_COMPLETED;
}

bool MemoryPort::load(std::uint64_t address, const unsigned char* bytes, unsigned count) {
    if (compares_) {
        if (loaded_.empty())
            loaded_from_ = address;
        const std::uint64_t first = std::min(loaded_from_, address);
        loaded_.insert(loaded_.begin(), loaded_from_ - first, 0);
        loaded_from_ = first;
        loaded_.resize(std::max<std::size_t>(loaded_.size(), address - first + count));
        std::copy_n(bytes, count, loaded_.begin() + static_cast<std::ptrdiff_t>(address - first));
    }
    std::vector<unsigned char> data(count);
    MemoryRequest request{tlm::TLM_READ_COMMAND, 1, count, {address}, data.data()};
    if (socket->transport_dbg(request) == count && std::equal(data.begin(), data.end(), bytes))
        return true;
    std::copy_n(bytes, count, data.begin());
    request.command = tlm::TLM_WRITE_COMMAND;
    return socket->transport_dbg(request) == count && holds(address, bytes, count);
}

bool MemoryPort::holds(std::uint64_t address, const unsigned char* bytes, unsigned count) {
    std::vector<unsigned char> data(count);
    MemoryRequest request{tlm::TLM_READ_COMMAND, 1, count, {address}, data.data()};
    return socket->transport_dbg(request) != count || std::equal(data.begin(), data.end(), bytes);
}

}  // namespace tessera
