#include "testbench/check/transport/read_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace tessera {

ReadCheck::ReadCheck(const sc_core::sc_module_name& name, std::string port) : sc_module(name), port_(std::move(port)) {
    socket.register_b_transport(this, &ReadCheck::b_transport);
    socket.register_nb_transport_fw(this, &ReadCheck::nb_transport_fw);
    socket.register_transport_dbg(this, &ReadCheck::transport_dbg);
    to_memory.register_nb_transport_bw(this, &ReadCheck::nb_transport_bw);
}

unsigned ReadCheck::transport_dbg(MemoryRequest& request) {
    return to_memory->transport_dbg(request);
}

void ReadCheck::compare(const MemoryRequest& asked, const MemoryRequest& answer) {
    if (asked.command != tlm::TLM_READ_COMMAND || !answer.is_ok())
        return;
    const unsigned bytes = asked.entry_bytes;  // wider for a cache's line than for a table's entry
    std::vector<unsigned char> held(bytes);
    for (unsigned k = 0; k < asked.count; ++k) {
        MemoryRequest look{tlm::TLM_READ_COMMAND, 1, bytes, {asked.address[k]}, held.data()};
        ++result_.entries;
        const unsigned char* const brought = asked.entry(k);
        if (to_memory->transport_dbg(look) == bytes && std::memcmp(held.data(), brought, bytes) == 0)
            continue;
        if (result_.wrong++ > 0)
            continue;
        std::uint64_t expected = 0;
        std::uint64_t found = 0;
        const std::size_t shown = std::min<std::size_t>(bytes, sizeof expected);
        std::memcpy(&expected, held.data(), shown);
        std::memcpy(&found, brought, shown);
        result_.first_wrong = fmt::format("{}: a read at address {:#x} returned {:#x}; the memory holds {:#x}", port_,
                                          asked.address[k], found, expected);
    }
}

void ReadCheck::b_transport(MemoryRequest& request, sc_core::sc_time& delay) {
    const MemoryRequest asked = request;
    to_memory->b_transport(request, delay);
    request.dmi_allowed = false;
    compare(asked, request);
}

tlm::tlm_sync_enum ReadCheck::nb_transport_fw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay) {
    under_way_.push_back({&request, request});
    return to_memory->nb_transport_fw(request, phase, delay);
}

tlm::tlm_sync_enum ReadCheck::nb_transport_bw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay) {
    if (phase == tlm::BEGIN_RESP) {
        const auto asked = std::find_if(under_way_.begin(), under_way_.end(),
                                        [&](const Asked& one) { return one.request == &request; });
        if (asked != under_way_.end()) {
            compare(asked->copy, request);
            under_way_.erase(asked);
        }
    }
    return socket->nb_transport_bw(request, phase, delay);
}

}  // namespace tessera
