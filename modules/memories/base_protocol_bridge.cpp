#include "modules/memories/base_protocol_bridge.h"

#include <algorithm>
#include <sstream>

#include "modules/sockets/stream.h"

namespace tessera {

namespace {

void fill(tlm::tlm_generic_payload& payload, const MemoryRequest& request, unsigned k) {
    payload.set_command(request.command);
    payload.set_address(request.address[k]);
    payload.set_data_ptr(request.entry(k));
    payload.set_data_length(request.entry_bytes);
    payload.set_streaming_width(request.entry_bytes);
    payload.set_byte_enable_ptr(nullptr);
    payload.set_dmi_allowed(false);
    payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
}

}  // namespace

struct BaseProtocolBridge::Entry {
    explicit Entry(tlm::tlm_mm_interface* manager) : payload(manager) {}

    tlm::tlm_generic_payload payload;
    MemoryRequest* request = nullptr;  // null: answered
};

BaseProtocolBridge::BaseProtocolBridge(const sc_core::sc_module_name& name, CycleScheduler& clock, unsigned buffer,
                                       const StallParameters& stalls)
    : MemoryServer(name, clock, buffer, stalls) {
    clock.attach(*this);
    to_memory.register_nb_transport_bw(this, &BaseProtocolBridge::nb_transport_bw);
    to_memory.register_invalidate_direct_mem_ptr(this, &BaseProtocolBridge::invalidate_direct_mem_ptr);
}

BaseProtocolBridge::~BaseProtocolBridge() = default;

BaseProtocolBridge::Entry& BaseProtocolBridge::unused_entry() {
    if (unused_.empty()) {
        entries_.push_back(std::make_unique<Entry>(this));
        return *entries_.back();
    }
    Entry& entry = *unused_.back();
    unused_.pop_back();
    return entry;
}

void BaseProtocolBridge::free(tlm::tlm_generic_payload* payload) {
    payload->reset();
    const auto entry =
        std::find_if(entries_.begin(), entries_.end(), [&](const auto& one) { return &one->payload == payload; });
    unused_.push_back(entry->get());
}

std::uint64_t BaseProtocolBridge::ready(const MemoryRequest&) const {
    return sending_ ? ~std::uint64_t{0} : next_send_;
}

std::uint64_t BaseProtocolBridge::serve(MemoryRequest& request, std::uint64_t) {
    gathers_.push_back({&request, request.count, 0});
    request.response = tlm::TLM_OK_RESPONSE;
    sent_ = 0;
    sending_ = true;
    return ~std::uint64_t{0};
}

void BaseProtocolBridge::step() {
    const std::uint64_t cycle = clock_.last_cycle();
    send_entry(cycle);
    MemoryServer::step();
    send_entry(cycle);
}

void BaseProtocolBridge::send_entry(std::uint64_t cycle) {
    if (!sending_ || on_offer_ != nullptr || next_send_ > cycle)
        return;
    MemoryRequest& request = *gathers_.back().request;
    Entry& entry = unused_entry();
    entry.request = &request;
    entry.payload.acquire();
    fill(entry.payload, request, sent_++);
    ++entries_sent_;
    sending_ = sent_ < request.count;
    next_send_ = cycle + 1;
    wake_at(next_send_);
    on_offer_ = &entry;
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    const tlm::tlm_sync_enum status = to_memory->nb_transport_fw(entry.payload, phase, delay);
    if (status == tlm::TLM_ACCEPTED)
        return;
    if (on_offer_ == nullptr)
        stream_protocol_error(to_memory.name(), "BEGIN_REQ was answered twice", &clock_);
    const std::uint64_t then = cycle + clock_.cycles(delay);
    on_offer_ = nullptr;
    next_send_ = std::max(next_send_, then);
    wake_at(next_send_);
    if (status == tlm::TLM_UPDATED && phase == tlm::END_REQ)
        return;
    if (status == tlm::TLM_UPDATED && phase != tlm::BEGIN_RESP)
        stream_protocol_error(to_memory.name(), "BEGIN_REQ was answered by neither END_REQ nor BEGIN_RESP", &clock_);
    if (status == tlm::TLM_UPDATED) {
        phase = tlm::END_RESP;
        to_memory->nb_transport_fw(entry.payload, phase, delay);
    }
    answered(entry, then);
}

/// The answer to an entry arrives in `cycle`. With that of its last entry a request is answered.
void BaseProtocolBridge::answered(Entry& entry, std::uint64_t cycle) {
    const auto gather =
        std::find_if(gathers_.begin(), gathers_.end(), [&](const Gather& one) { return one.request == entry.request; });
    if (entry.payload.get_response_status() != tlm::TLM_OK_RESPONSE)
        gather->request->response = entry.payload.get_response_status();
    gather->answer_at = std::max(gather->answer_at, cycle);
    entry.request = nullptr;
    entry.payload.release();
    if (--gather->unanswered > 0)
        return;
    finish(*gather->request, gather->answer_at);
    gathers_.erase(gather);
}

tlm::tlm_sync_enum BaseProtocolBridge::nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                                       sc_core::sc_time& delay) {
    if (phase != tlm::END_REQ && phase != tlm::BEGIN_RESP)
        return tlm::TLM_ACCEPTED;  // no phase of the base protocol's: it may be ignored
    const std::uint64_t cycle = now() + clock_.cycles(delay);
    const bool ends_request = on_offer_ != nullptr && &on_offer_->payload == &payload;
    if (ends_request) {
        on_offer_ = nullptr;
        next_send_ = std::max(next_send_, cycle);
        wake_at(next_send_);
    }
    if (phase == tlm::END_REQ) {
        if (!ends_request)
            stream_protocol_error(to_memory.name(), "END_REQ for a request that is not pending", &clock_);
        return tlm::TLM_ACCEPTED;
    }
    const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const auto& one) {
        return &one->payload == &payload && one->request != nullptr;
    });
    if (entry == entries_.end())
        stream_protocol_error(to_memory.name(), "BEGIN_RESP for an unknown request", &clock_);
    answered(**entry, cycle);
    return tlm::TLM_COMPLETED;
}

void BaseProtocolBridge::invalidate_direct_mem_ptr(sc_dt::uint64 start, sc_dt::uint64 end) {
    for (unsigned port = 0; port < socket.size(); ++port)
        socket[static_cast<int>(port)]->invalidate_direct_mem_ptr(start, end);
}

void BaseProtocolBridge::b_transport(int, MemoryRequest& request, sc_core::sc_time& delay) {
    for (unsigned k = 0; k < request.count; ++k) {
        tlm::tlm_generic_payload payload;
        fill(payload, request, k);
        to_memory->b_transport(payload, delay);
        request.response = payload.get_response_status();
        request.dmi_allowed = payload.is_dmi_allowed();
        if (!request.is_ok())
            return;
    }
}

bool BaseProtocolBridge::get_direct_mem_ptr(int, MemoryRequest& request, tlm::tlm_dmi& dmi) {
    tlm::tlm_generic_payload payload;
    fill(payload, request, 0);
    return to_memory->get_direct_mem_ptr(payload, dmi);
}

/// The memory may move fewer bytes than it is asked for.
unsigned BaseProtocolBridge::transport_dbg(int, MemoryRequest& request) {
    for (unsigned k = 0; k < request.count; ++k) {
        for (unsigned moved = 0, now = 0; moved < request.entry_bytes; moved += now) {
            tlm::tlm_generic_payload payload;
            fill(payload, request, k);
            payload.set_address(request.address[k] + moved);
            payload.set_data_ptr(request.entry(k) + moved);
            payload.set_data_length(request.entry_bytes - moved);
            payload.set_streaming_width(request.entry_bytes - moved);
            now = to_memory->transport_dbg(payload);
            if (now == 0 || now > request.entry_bytes - moved)
                return 0;
        }
    }
    return request.bytes();
}

std::string BaseProtocolBridge::describe_contents() const {
    std::ostringstream entry;
    if (on_offer_ != nullptr)
        entry << to_memory.name() << " waits for END_REQ of address 0x" << std::hex << on_offer_->payload.get_address();
    return listed(MemoryServer::describe_contents(), entry.str());
}

}  // namespace tessera
