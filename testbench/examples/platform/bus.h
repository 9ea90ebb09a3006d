#pragma once
#include <tlm_utils/multi_passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <algorithm>
#include <cstdint>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/sockets/generic_payload.h"

/// Memory from address 0. 20 ns per transfer.
class Memory : public sc_core::sc_module {
  public:
    tlm_utils::multi_passthrough_target_socket<Memory> bus{"bus"};
    std::vector<unsigned char> bytes;

    Memory(const sc_core::sc_module_name& name, std::size_t size) : sc_module(name), bytes(size) {
        bus.register_b_transport(this, &Memory::b_transport);
    }

  private:
    void b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
        delay += sc_core::sc_time(20, sc_core::SC_NS);
        payload.set_response_status(access(payload));
    }
    tlm::tlm_response_status access(tlm::tlm_generic_payload& payload) {
        const std::uint64_t address = payload.get_address(), length = payload.get_data_length();
        if (payload.get_command() == tlm::TLM_IGNORE_COMMAND)
            return tlm::TLM_OK_RESPONSE;
        if (length == 0 || tessera::is_stream(payload))
            return tlm::TLM_BURST_ERROR_RESPONSE;
        if (!tessera::all_bytes_enabled(payload))
            return tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE;
        if (length > bytes.size() || address > bytes.size() - length)
            return tlm::TLM_ADDRESS_ERROR_RESPONSE;
        if (payload.is_read())
            std::copy_n(&bytes[address], length, payload.get_data_ptr());
        else
            std::copy_n(payload.get_data_ptr(), length, &bytes[address]);
        return tlm::TLM_OK_RESPONSE;
    }
};

/// Maps the device's registers at `registers`, memory everywhere else.
class Router : public sc_core::sc_module {
  public:
    static constexpr std::uint64_t registers = 0x4000'0000;
    tlm_utils::multi_passthrough_target_socket<Router> from{"from"};
    tlm_utils::simple_initiator_socket<Router> to_device{"to_device"};
    tlm_utils::simple_initiator_socket<Router> to_memory{"to_memory"};
    std::uint64_t bytes_moved = 0;  ///< to and from memory

    explicit Router(const sc_core::sc_module_name& name) : sc_module(name) {
        from.register_b_transport(this, &Router::b_transport);
    }

  private:
    void b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
        const std::uint64_t address = payload.get_address();
        if (address < registers) {
            bytes_moved += payload.get_data_length();
            to_memory->b_transport(payload, delay);
            return;
        }
        payload.set_address(address - registers);
        to_device->b_transport(payload, delay);
        payload.set_address(address);
    }
};
