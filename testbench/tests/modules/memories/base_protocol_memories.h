#pragma once
#include <tlm_utils/multi_passthrough_target_socket.h>
#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/peq_with_get.h>
#include <tlm_utils/simple_target_socket.h>
#include <cstdint>
#include <map>
#include <systemc>
#include <tlm>

/// Memories of the TLM-2.0 base protocol, as third parties write them.
namespace tessera::testing {

/// Bytes that read as their own addresses until they are written.
struct Bytes {
    std::map<std::uint64_t, unsigned char> written;

    /// Returns the bytes read or written.
    unsigned access(tlm::tlm_generic_payload& payload) {
        for (unsigned k = 0; k < payload.get_data_length(); ++k) {
            const std::uint64_t address = payload.get_address() + k;
            if (payload.is_write())
                written[address] = payload.get_data_ptr()[k];
            else
                payload.get_data_ptr()[k] =
                    written.count(address) > 0 ? written[address] : static_cast<unsigned char>(address);
        }
        payload.set_response_status(tlm::TLM_OK_RESPONSE);
        return payload.get_data_length();
    }
};

/// Blocking transport only, in a simple_target_socket: the response implies END_REQ.
struct BlockingMemory : sc_core::sc_module {
    tlm_utils::simple_target_socket<BlockingMemory> socket{"socket"};
    Bytes bytes;
    sc_core::sc_time latency;
    unsigned accesses = 0;
    bool waits = false;  ///< lets the latency pass, instead of annotating it

    BlockingMemory(const sc_core::sc_module_name& name, const sc_core::sc_time& its_latency)
        : sc_module(name), latency(its_latency) {
        socket.register_b_transport(this, &BlockingMemory::b_transport);
        socket.register_transport_dbg(this, &BlockingMemory::transport_dbg);
    }

  private:
    void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
        ++accesses;
        bytes.access(payload);
        if (waits)
            wait(latency);
        else
            delay += latency;
    }
    unsigned transport_dbg(tlm::tlm_generic_payload& payload) { return bytes.access(payload); }
};

/// Without latency, for several initiators.
struct SharedMemory : sc_core::sc_module {
    tlm_utils::multi_passthrough_target_socket<SharedMemory> socket{"socket"};
    Bytes bytes;

    explicit SharedMemory(const sc_core::sc_module_name& name) : sc_module(name) {
        socket.register_b_transport(this, &SharedMemory::b_transport);
        socket.register_transport_dbg(this, &SharedMemory::transport_dbg);
        socket.register_nb_transport_fw(this, &SharedMemory::nb_transport_fw);
    }

  private:
    void b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time&) { bytes.access(payload); }
    unsigned transport_dbg(int, tlm::tlm_generic_payload& payload) { return bytes.access(payload); }
    tlm::tlm_sync_enum nb_transport_fw(int, tlm::tlm_generic_payload& payload, tlm::tlm_phase&, sc_core::sc_time&) {
        bytes.access(payload);
        return tlm::TLM_COMPLETED;
    }
};

/// Any latency and bandwidth, pipelined: END_REQ after the request's last byte, the response a latency later.
struct PipelinedMemory : sc_core::sc_module {
    tlm_utils::passthrough_target_socket<PipelinedMemory> socket{"socket"};
    Bytes bytes;
    unsigned bandwidth;  ///< bytes a cycle; 0: any number
    unsigned uncounted;  ///< bytes at the end of a request that take no time
    sc_core::sc_time its_period;
    unsigned latency;

    PipelinedMemory(const sc_core::sc_module_name& name, const sc_core::sc_time& cycle, unsigned its_latency,
                    unsigned its_bandwidth = 0, unsigned its_uncounted = 0)
        : sc_module(name), bandwidth(its_bandwidth), uncounted(its_uncounted), its_period(cycle), latency(its_latency) {
        socket.register_nb_transport_fw(this, &PipelinedMemory::nb_transport_fw);
        socket.register_transport_dbg(this, &PipelinedMemory::transport_dbg);
        SC_HAS_PROCESS(PipelinedMemory);
        SC_METHOD(answer);
        sensitive << answers_.get_event();
        dont_initialize();
    }

  private:
    tlm::tlm_sync_enum nb_transport_fw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                       sc_core::sc_time& delay) {
        bytes.access(payload);
        const unsigned counted = payload.get_data_length() - uncounted;
        const unsigned taken = bandwidth == 0 ? 1 : (counted + bandwidth - 1) / bandwidth;
        // a table's port takes the address in its cycle; a channel responds after the last byte
        answers_.notify(payload, its_period * (latency + (bandwidth == 0 ? 0 : taken)));
        phase = tlm::END_REQ;
        delay = its_period * taken;
        return tlm::TLM_UPDATED;
    }
    unsigned transport_dbg(tlm::tlm_generic_payload& payload) { return bytes.access(payload); }
    void answer() {
        while (tlm::tlm_generic_payload* payload = answers_.get_next_transaction()) {
            tlm::tlm_phase phase = tlm::BEGIN_RESP;
            sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
            socket->nb_transport_bw(*payload, phase, delay);
        }
    }

    tlm_utils::peq_with_get<tlm::tlm_generic_payload> answers_{"answers"};
};

}  // namespace tessera::testing
