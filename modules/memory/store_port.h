#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/clock/clock.h"

namespace tessera {

/// A unit's port for reading and writing records of one size in off-chip memory (timed mode, nb_transport, base
/// protocol): one request on offer at a time, several under way, answered in order. Responses other than OK and
/// breaches of the protocol are SC_ERRORs.
class StorePort : public tlm::tlm_mm_interface {
  public:
    tlm_utils::simple_initiator_socket<StorePort> socket;

    StorePort(const char* name, Clock& clock, Clocked& unit, std::size_t record_bytes,
              std::size_t most_under_way);
    ~StorePort() override;

    /// Binds the port to a memory (with a socket of that name).
    template <class Memory>
    void bind(Memory& memory) {
        bind(memory, memory);
    }
    /// The same through what stands before the memory.
    template <class Interposer>
    void bind(Interposer& before, const sc_core::sc_object& memory) {
        socket.bind(before.socket);
        memory_ = &memory;
    }
    /// The memory: who is waited for.
    const sc_core::sc_object* memory() const { return memory_; }

    /// A request may be made.
    bool may_request() const { return !on_offer_ && under_way_ < slots_.size(); }
    bool on_offer() const { return on_offer_; }
    std::size_t under_way() const { return under_way_; }

    /// The record that write() will send; to be filled in just before.
    unsigned char* record_to_write();
    void write(std::uint64_t address);
    void read(std::uint64_t address);

    bool answered() const;
    bool answer_is_read() const;
    const unsigned char* answer() const;
    void pop_answer();

  private:
    struct Slot;

    void request(tlm::tlm_command command, std::uint64_t address);
    tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                       sc_core::sc_time& delay);
    void free(tlm::tlm_generic_payload*) override {}  // the slots are reused
    Slot& slot(std::size_t k) const { return *slots_[(first_ + k) % slots_.size()]; }

    Clock& clock_;
    Clocked& unit_;
    std::vector<std::unique_ptr<Slot>> slots_;  // a ring of requests, oldest first
    std::size_t first_ = 0;
    std::size_t under_way_ = 0;
    bool on_offer_ = false;
    const sc_core::sc_object* memory_ = nullptr;
};

}  // namespace tessera
