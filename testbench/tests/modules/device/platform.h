#pragma once
#include <tlm_utils/multi_passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>
#include <tlm_utils/tlm_quantumkeeper.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/device/device.h"
#include "modules/device/driver/tessera_driver.h"

/// A platform around devices: a memory, a router, and a processor that runs a test's program.
namespace tessera::testing {

/// Memory at [base, base + size): loosely timed, with any number of initiators. Counts accesses that should not happen.
struct BusMemory : sc_core::sc_module {
    tlm_utils::multi_passthrough_target_socket<BusMemory> socket{"socket"};
    std::uint64_t base;
    std::vector<unsigned char> bytes;
    sc_core::sc_time latency{20, sc_core::SC_NS};
    bool waits = false;  ///< lets the latency pass itself, instead of annotating it
    /// The writable addresses, and the number of writes elsewhere.
    struct Range {
        std::uint64_t first = 0, end = 0;
    };
    std::vector<Range> writable;
    std::function<Range()> writable_now;  ///< if set, in their place
    unsigned writes_outside = 0;
    std::uint64_t failing_from = 1, failing_to = 0;  ///< answers accesses to these addresses by an error
    /// If set: an access waits for as long as this returns, and fails if it returns more than zero.
    std::function<sc_core::sc_time(const tlm::tlm_generic_payload&)> fails_after;
    unsigned reads = 0, writes = 0, longest = 0, across = 0;
    std::uint64_t bytes_read = 0, bytes_written = 0;
    unsigned burst_bytes = 64;
    sc_core::sc_time longest_delay;  ///< with which it was called

    BusMemory(const sc_core::sc_module_name& name, std::uint64_t its_base, std::size_t size)
        : sc_module(name), base(its_base), bytes(size) {
        socket.register_b_transport(this, &BusMemory::b_transport);
    }

    std::uint64_t put(std::uint64_t address, const std::vector<unsigned char>& data) {
        REQUIRE(address - base + data.size() <= bytes.size());
        std::copy(data.begin(), data.end(), bytes.begin() + static_cast<std::ptrdiff_t>(address - base));
        return address;
    }

  private:
    bool may_write(std::uint64_t first, std::uint64_t end) const {
        const auto inside = [&](const Range& range) { return first >= range.first && end <= range.end; };
        return writable_now ? inside(writable_now()) : std::any_of(writable.begin(), writable.end(), inside);
    }
    void b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
        const std::uint64_t first = payload.get_address(), length = payload.get_data_length();
        (payload.is_write() ? writes : reads) += 1;
        (payload.is_write() ? bytes_written : bytes_read) += length;
        longest = std::max(longest, payload.get_data_length());
        across += first / burst_bytes != (first + length - 1) / burst_bytes ? 1u : 0u;
        longest_delay = std::max(longest_delay, delay);
        const sc_core::sc_time failure = fails_after ? fails_after(payload) : sc_core::SC_ZERO_TIME;
        if (waits || failure != sc_core::SC_ZERO_TIME)
            wait(std::max(latency, failure));
        else
            delay += latency;
        if (first < base || first - base > bytes.size() || length > bytes.size() - (first - base) ||
            (first + length > failing_from && first <= failing_to) || failure != sc_core::SC_ZERO_TIME) {
            payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
            return;
        }
        unsigned char* const at = &bytes[first - base];
        if (payload.is_read()) {
            std::copy_n(at, length, payload.get_data_ptr());
        } else {
            writes_outside += may_write(first, first + length) ? 0u : 1u;
            std::copy_n(payload.get_data_ptr(), length, at);
        }
        payload.set_response_status(tlm::TLM_OK_RESPONSE);
    }
};

/// Routes an access to the device whose registers contain its address, any other to the memory.
struct Router : sc_core::sc_module {
    tlm_utils::multi_passthrough_target_socket<Router> from{"from"};
    sc_core::sc_vector<tlm_utils::simple_initiator_socket<Router>> to_devices;
    tlm_utils::simple_initiator_socket<Router> to_memory{"to_memory"};
    static constexpr std::uint64_t registers = 0x4000'0000;

    Router(const sc_core::sc_module_name& name, std::size_t devices)
        : sc_module(name), to_devices("to_devices", devices) {
        from.register_b_transport(this, &Router::b_transport);
    }

  private:
    void b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
        const std::uint64_t address = payload.get_address();
        const std::uint64_t device = (address - registers) / register_bytes;
        if (address < registers || device >= to_devices.size()) {
            to_memory->b_transport(payload, delay);
            return;
        }
        payload.set_address((address - registers) % register_bytes);
        to_devices[device]->b_transport(payload, delay);
        payload.set_address(address);
    }
};

/// A processor that runs a program in a thread: loosely timed with a quantum, or approximately timed by nb_transport.
struct Processor : sc_core::sc_module {
    tlm_utils::simple_initiator_socket<Processor> bus{"bus"};
    sc_core::sc_in<bool> interrupt{"interrupt"};
    std::function<void(Processor&)> program;
    bool approximately_timed = false;
    bool finished = false;
    unsigned accesses = 0;

    explicit Processor(const sc_core::sc_module_name& name) : sc_module(name) {
        bus.register_nb_transport_bw(this, &Processor::nb_transport_bw);
        SC_HAS_PROCESS(Processor);
        SC_THREAD(run);
    }

    tlm::tlm_response_status access(tlm::tlm_command command, std::uint64_t address, unsigned char* data,
                                    unsigned length, unsigned char* enables = nullptr, unsigned width = ~0u,
                                    unsigned enables_length = ~0u) {
        ++accesses;
        tlm::tlm_generic_payload payload;
        payload.set_command(command);
        payload.set_address(address);
        payload.set_data_ptr(data);
        payload.set_data_length(length);
        payload.set_streaming_width(width == ~0u ? length : width);
        payload.set_byte_enable_ptr(enables);
        payload.set_byte_enable_length(enables == nullptr ? 0 : enables_length == ~0u ? length : enables_length);
        if (approximately_timed) {
            transport(payload);
        } else {
            sc_core::sc_time delay = keeper.get_local_time();
            bus->b_transport(payload, delay);
            keeper.set(delay);
            if (keeper.need_sync())
                keeper.sync();
        }
        return payload.get_response_status();
    }
    int read32(std::uint64_t address, std::uint32_t& value) {
        unsigned char bytes[4] = {};
        const bool ok = access(tlm::TLM_READ_COMMAND, address, bytes, 4) == tlm::TLM_OK_RESPONSE;
        value = datapath::load_word(bytes);
        return ok ? 0 : 1;
    }
    int write32(std::uint64_t address, std::uint32_t value) {
        unsigned char bytes[4];
        datapath::store_word(value, bytes);
        return access(tlm::TLM_WRITE_COMMAND, address, bytes, 4) == tlm::TLM_OK_RESPONSE ? 0 : 1;
    }
    void pass(const sc_core::sc_time& time) {
        keeper.sync();
        wait(time);
        keeper.reset();
    }
    void wait_for_interrupt() {
        keeper.sync();
        while (!interrupt.read())
            wait(interrupt.posedge_event());
    }

    tlm_utils::tlm_quantumkeeper keeper;

  private:
    void run() {
        keeper.reset();
        program(*this);
        keeper.sync();
        finished = true;
    }
    /// Four phases; one transaction at a time.
    void transport(tlm::tlm_generic_payload& payload) {
        tlm::tlm_phase phase = tlm::BEGIN_REQ;
        sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
        answered_ = false;
        const tlm::tlm_sync_enum status = bus->nb_transport_fw(payload, phase, delay);
        if (status == tlm::TLM_COMPLETED || (status == tlm::TLM_UPDATED && phase == tlm::BEGIN_RESP))
            answered_ = true;
        while (!answered_)
            wait(answer_);
        if (status != tlm::TLM_COMPLETED) {
            phase = tlm::END_RESP;
            delay = sc_core::SC_ZERO_TIME;
            bus->nb_transport_fw(payload, phase, delay);
        }
    }
    tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload&, tlm::tlm_phase& phase, sc_core::sc_time& delay) {
        if (phase == tlm::BEGIN_RESP) {
            answered_ = true;
            answer_.notify(delay);
        }
        return tlm::TLM_ACCEPTED;
    }

    bool answered_ = false;
    sc_core::sc_event answer_;
};

/// The driver's view of device number `device`.
struct DriverContext {
    Processor* processor;
    std::uint64_t registers;            ///< their bus address
    const BusMemory* memory = nullptr;  ///< reads it past the bus: a processor that is joined to the device alone

    tessera_platform platform() {
        return {this,
                [](void* self, std::uint32_t offset, std::uint32_t* value) {
                    auto* me = static_cast<DriverContext*>(self);
                    return me->processor->read32(me->registers + offset, *value);
                },
                [](void* self, std::uint32_t offset, std::uint32_t value) {
                    auto* me = static_cast<DriverContext*>(self);
                    return me->processor->write32(me->registers + offset, value);
                },
                [](void* self, std::uint64_t address, unsigned char* bytes, std::size_t count) {
                    auto* me = static_cast<DriverContext*>(self);
                    if (me->memory != nullptr) {
                        std::copy_n(&me->memory->bytes[address - me->memory->base], count, bytes);
                        return 0;
                    }
                    int failed = 0;
                    for (std::size_t k = 0; k < count; k += 4) {
                        std::uint32_t word = 0;
                        failed |= me->processor->read32(address + k, word);
                        datapath::store_word(word, bytes + k);
                    }
                    return failed;
                },
                [](void* self) {
                    static_cast<DriverContext*>(self)->processor->pass(sc_core::sc_time(1, sc_core::SC_US));
                }};
    }
};

}  // namespace tessera::testing
