#include "testbench/check/read_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "modules/memory/gather_extension.h"

namespace tessera {

ReadCheck::ReadCheck(const sc_core::sc_module_name& name, std::string port)
    : sc_module(name), port_(std::move(port)) {
    socket.register_b_transport(this, &ReadCheck::b_transport);
    socket.register_nb_transport_fw(this, &ReadCheck::nb_transport_fw);
    socket.register_transport_dbg(this, &ReadCheck::transport_dbg);
    to_memory.register_nb_transport_bw(this, &ReadCheck::nb_transport_bw);
}

unsigned ReadCheck::transport_dbg(Payload& payload) {
    return to_memory->transport_dbg(payload);
}

ReadCheck::Asked ReadCheck::asked_by(const Payload& payload) {
    Asked asked;
    asked.payload = &payload;
    if (const auto* gather = payload.get_extension<GatherExtension>()) {
        asked.count = gather->count;
        asked.address = gather->address;
    } else {
        asked.count = 1;
        asked.address[0] = payload.get_address();
    }
    return asked;
}

void ReadCheck::compare(const Asked& asked, const Payload& payload) {
    if (!payload.is_read() || !payload.is_response_ok())
        return;
    const unsigned bytes = payload.get_data_length() / asked.count;
    for (unsigned k = 0; k < asked.count; ++k) {
        std::array<unsigned char, 8> held{};
        Payload look;
        look.set_command(tlm::TLM_READ_COMMAND);
        look.set_address(asked.address[k]);
        look.set_data_ptr(held.data());
        look.set_data_length(bytes);
        look.set_streaming_width(bytes);
        ++result_.entries;
        const unsigned char* const brought = payload.get_data_ptr() + std::size_t{k} * bytes;
        if (to_memory->transport_dbg(look) == bytes && std::memcmp(held.data(), brought, bytes) == 0)
            continue;
        if (result_.wrong++ > 0)
            continue;
        std::uint64_t expected = 0;
        std::uint64_t found = 0;
        std::memcpy(&expected, held.data(), bytes);
        std::memcpy(&found, brought, bytes);
        result_.first_wrong = fmt::format("{}: a read at address {:#x} brought {:#x}; the memory holds {:#x}",
                                          port_, asked.address[k], found, expected);
    }
}

void ReadCheck::b_transport(Payload& payload, sc_core::sc_time& delay) {
    const Asked asked = asked_by(payload);
    to_memory->b_transport(payload, delay);
    payload.set_dmi_allowed(false);
    compare(asked, payload);
}

tlm::tlm_sync_enum ReadCheck::nb_transport_fw(Payload& payload, tlm::tlm_phase& phase,
                                              sc_core::sc_time& delay) {
    under_way_.push_back(asked_by(payload));
    return to_memory->nb_transport_fw(payload, phase, delay);
}

tlm::tlm_sync_enum ReadCheck::nb_transport_bw(Payload& payload, tlm::tlm_phase& phase,
                                              sc_core::sc_time& delay) {
    if (phase == tlm::BEGIN_RESP) {
        const auto asked = std::find_if(under_way_.begin(), under_way_.end(),
                                        [&](const Asked& one) { return one.payload == &payload; });
        if (asked != under_way_.end()) {
            compare(*asked, payload);
            under_way_.erase(asked);
        }
    }
    return socket->nb_transport_bw(payload, phase, delay);
}

}  // namespace tessera
