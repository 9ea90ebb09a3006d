#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/tlm_quantumkeeper.h>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <systemc>
#include <tlm>

#include "bus.h"
#include "modules/device/driver/tessera_driver.h"

/// A loosely timed processor: runs a program, which is a C++ function with access to the bus.
class Processor : public sc_core::sc_module {
  public:
    tlm_utils::simple_initiator_socket<Processor> bus{"bus"};
    sc_core::sc_in<bool> interrupt{"interrupt"};
    std::function<void(Processor&)> program;

    explicit Processor(const sc_core::sc_module_name& name) : sc_module(name) {
        SC_HAS_PROCESS(Processor);
        SC_THREAD(run);
    }

    /// Returns 0, or 1 on a bus error. The simulation's host is little endian, as is the bus.
    int access(tlm::tlm_command command, std::uint64_t address, void* data, std::size_t length) {
        tlm::tlm_generic_payload payload;
        payload.set_command(command);
        payload.set_address(address);
        payload.set_data_ptr(static_cast<unsigned char*>(data));
        payload.set_data_length(static_cast<unsigned>(length));
        payload.set_streaming_width(static_cast<unsigned>(length));
        sc_core::sc_time delay = time_.get_local_time();
        bus->b_transport(payload, delay);
        time_.set(delay);
        if (time_.need_sync())
            time_.sync();
        return payload.is_response_ok() ? 0 : 1;
    }
    /// Waits for the interrupt or for 10 us: a full ring raises no interrupt.
    void wait_for_interrupt() {
        time_.sync();
        if (!interrupt.read())
            wait(sc_core::sc_time(10, sc_core::SC_US), interrupt.posedge_event());
    }

    /// The platform functions that the driver needs.
    tessera_platform platform() {
        return {this,
                [](void* self, std::uint32_t offset, std::uint32_t* value) {
                    return of(self).access(tlm::TLM_READ_COMMAND, Router::registers + offset, value, 4);
                },
                [](void* self, std::uint32_t offset, std::uint32_t value) {
                    return of(self).access(tlm::TLM_WRITE_COMMAND, Router::registers + offset, &value, 4);
                },
                [](void* self, std::uint64_t address, unsigned char* bytes, std::size_t count) {
                    return of(self).access(tlm::TLM_READ_COMMAND, address, bytes, count);
                },
                [](void* self) { of(self).wait_for_interrupt(); }};
    }

  private:
    static Processor& of(void* self) { return *static_cast<Processor*>(self); }
    void run() {
        time_.reset();
        program(*this);
        time_.sync();
    }

    tlm_utils::tlm_quantumkeeper time_;
};
