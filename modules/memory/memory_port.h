#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <cstdint>
#include <cstring>
#include <memory>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/clock/clock.h"
#include "modules/memory/gather_extension.h"

namespace tessera {

/// A unit's read port on a table. Every response is checked: one that is not OK is an SC_ERROR that names the port,
/// the address and the response.
///
/// Functional mode: DMI where the memory grants it and the unit may use it, else b_transport; the same values, the
/// same added time and the same counts either way.
/// Timed mode: nb_transport, base protocol. One request on offer at a time (END_REQ withheld: the memory's buffer is
/// full), several under way, answered in order. Breaches of the protocol are SC_ERRORs.
class MemoryPort : public tlm::tlm_mm_interface {
  public:
    tlm_utils::simple_initiator_socket<MemoryPort> socket;

    /// entry_bytes: 1 to 8.
    MemoryPort(const char* name, unsigned entry_bytes, bool use_direct_memory);
    ~MemoryPort() override;

    /// Several reads in a row. Through DMI they are counted and timed once, at the end; on destruction.
    class Burst {
      public:
        Burst(MemoryPort& port, sc_core::sc_time& delay)
            : port_(port),
              delay_(delay),
              direct_(port.direct_),
              start_(port.direct_start_),
              bytes_(port.direct_bytes_),
              mask_(port.mask_) {}
        ~Burst() {
            port_.reads_ += direct_reads_;
            delay_ += sc_core::sc_time::from_value(direct_reads_ * port_.direct_time_.value());
        }
        Burst(const Burst&) = delete;
        Burst& operator=(const Burst&) = delete;

        /// The entry at a byte address, zero-extended.
        std::uint64_t read(std::uint64_t address) {
            if (address - start_ >= bytes_)
                return port_.read_by_transaction(address, delay_);
            ++direct_reads_;
            std::uint64_t entry = 0;
            std::memcpy(&entry, direct_ + (address - start_), sizeof entry);
            return entry & mask_;
        }

      private:
        MemoryPort& port_;
        sc_core::sc_time& delay_;
        const unsigned char* direct_;
        std::uint64_t start_;
        std::uint64_t bytes_;
        std::uint64_t mask_;
        std::uint64_t direct_reads_ = 0;
    };

    /// The entry at a byte address, zero-extended. Adds the memory's read time to `delay`.
    std::uint64_t read(std::uint64_t address, sc_core::sc_time& delay) {
        return Burst(*this, delay).read(address);
    }

    /// Timed mode: `unit` is called when a request that had to wait is taken and when an answer comes.
    /// most_under_way: requests that may be unanswered at a time.
    void clocked_by(Clock& clock, Clocked& unit, std::size_t most_under_way);

    /// A request may be offered.
    bool may_request() const { return !on_offer_ && under_way_ < slots_.size(); }
    /// The request on offer has not been taken.
    bool on_offer() const { return on_offer_; }
    bool under_way() const { return under_way_ > 0; }
    std::size_t requests_under_way() const { return under_way_; }
    /// Of the newest request, if any: the address of its first entry.
    std::uint64_t last_address() const { return under_way_ == 0 ? 0 : last().payload.get_address(); }

    /// Asks for `count` entries, 1 to 9; more than one are a gather (gather_extension.h).
    void request(const std::uint64_t* addresses, unsigned count);

    /// The first unanswered request has been answered.
    bool answered() const { return answered_ > 0; }
    /// Entry k of that answer, zero-extended.
    std::uint64_t entry(unsigned k) const {
        std::uint64_t value = 0;
        // Eight bytes are there: the slot has as many for each entry.
        std::memcpy(&value, &slots_[first_]->data[std::size_t{k} * entry_bytes_], sizeof value);
        return value & mask_;
    }
    void pop_answer();

    /// Requests made in timed mode; entries read in either.
    std::uint64_t requests() const { return requests_; }
    std::uint64_t reads() const { return reads_; }
    unsigned entry_bytes() const { return entry_bytes_; }

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

  private:
    struct Slot {
        explicit Slot(tlm::tlm_mm_interface* manager) : payload(manager) { payload.set_extension(&gather); }
        ~Slot() { payload.clear_extension(&gather); }

        tlm::tlm_generic_payload payload;
        GatherExtension gather;
        std::array<unsigned char, std::size_t{8} * datapath::RectangleReads::most> data{};
        bool taken = false;
    };

    std::uint64_t read_by_transaction(std::uint64_t address, sc_core::sc_time& delay);
    void check_response(const tlm::tlm_generic_payload& payload) const;
    void ask_for_direct_memory();
    void invalidate_direct_mem_ptr(sc_dt::uint64 start, sc_dt::uint64 end);
    tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                       sc_core::sc_time& delay);
    void free(tlm::tlm_generic_payload*) override {}  // the slots are reused
    Slot& last() const {
        const std::size_t sum = first_ + under_way_ - 1;
        return *slots_[sum < slots_.size() ? sum : sum - slots_.size()];
    }

    unsigned entry_bytes_;
    std::uint64_t mask_;
    bool use_direct_memory_;
    std::uint64_t requests_ = 0;
    std::uint64_t reads_ = 0;
    const unsigned char* direct_ = nullptr;
    std::uint64_t direct_start_ = 0;
    // Addresses at which eight bytes may be loaded; the table's last few entries are read by transaction. 0: no DMI.
    std::uint64_t direct_bytes_ = 0;
    sc_core::sc_time direct_time_;
    tlm::tlm_generic_payload payload_;

    Clock* clock_ = nullptr;
    Clocked* unit_ = nullptr;
    std::vector<std::unique_ptr<Slot>> slots_;  // a ring of requests, oldest first
    std::size_t first_ = 0;
    std::size_t under_way_ = 0;
    std::size_t answered_ = 0;  // of these, the first so many
    bool on_offer_ = false;
    const sc_core::sc_object* memory_ = nullptr;
};

}  // namespace tessera
