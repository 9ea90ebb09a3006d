#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <systemc>
#include <tlm>
#include <type_traits>
#include <vector>

#include "modules/sockets/answer_watch.h"
#include "modules/sockets/memory_request.h"
#include "modules/timing/cycle_scheduler.h"
#include "modules/timing/ring.h"

namespace tessera {

/// A unit's port to a memory, for entries of one size: table entries, or records in off-chip memory.
///
/// Functional mode: read(). Uses DMI if the memory grants it and the unit may use it, else b_transport; values, added
/// time and counts are the same.
/// Timed mode: requests (memory_request.h). One on offer at a time, several under way, answered in order. The unit is
/// called when a delayed request is accepted and when an answer arrives.
/// Host: load() and holds(), by debug transport, in both modes.
/// Errors: responses other than OK, and violations of the protocol, are SC_ERRORs that name the port.
class MemoryPort {
  public:
    /// Leads from an object of the unit to the port.
    class Socket : public tlm_utils::simple_initiator_socket<MemoryPort, 32, MemoryProtocol> {
      public:
        const MemoryPort& port;

        Socket(const char* name, const MemoryPort& its_port);
        ~Socket() override;
    };
    Socket socket;

    /// entry_bytes: at least 1; at most 8 for read() and entry().
    MemoryPort(const char* name, std::size_t entry_bytes, bool use_direct_memory);
    ~MemoryPort();

    /// Functional mode: the entries at these byte addresses, zero-extended. Adds the memory's read time to `delay` for
    /// each of them. count: at most most_rectangle_entries.
    void read(const std::uint64_t* addresses, unsigned count, std::uint64_t* entries, sc_core::sc_time& delay) {
        const unsigned char* const direct = direct_;
        const std::uint64_t start = direct_start_, bytes = direct_bytes_, mask = mask_;
        for (unsigned k = 0; k < count; ++k) {
            const std::uint64_t offset = addresses[k] - start;
            if (offset >= bytes) {
                read_by_transactions(addresses, count, entries, delay);
                return;
            }
            std::uint64_t entry = 0;
            std::memcpy(&entry, direct + offset, sizeof entry);
            entries[k] = entry & mask;
        }
        reads_ += count;
        delay += direct_times_[count];
    }
    std::uint64_t read(std::uint64_t address, sc_core::sc_time& delay) {
        std::uint64_t entry = 0;
        read(&address, 1, &entry, delay);
        return entry;
    }

    /// Timed mode. most_under_way: requests that may be unanswered at a time; most_entries: of one of them.
    void clocked_by(CycleScheduler& clock, CycleProcess& unit, std::size_t most_under_way,
                    unsigned most_entries = datapath::most_rectangle_entries);

    /// True if a request may be offered.
    bool may_request() const { return !on_offer_ && !slots_.full(); }
    /// True if a request is on offer that has not been accepted.
    bool on_offer() const { return on_offer_; }
    std::size_t requests_under_way() const { return slots_.size(); }
    /// The address of the first entry of the newest request, if any.
    std::uint64_t last_address() const { return slots_.empty() ? 0 : slots_.back().request.address[0]; }

    /// Requests `count` entries, 1 to most_rectangle_entries.
    void request(const std::uint64_t* addresses, unsigned count);
    void request(std::uint64_t address) { request(&address, 1); }
    /// The entry that write() will send. Fill it in just before.
    unsigned char* entry_to_write() { return slots_.at(slots_.size()).data.data(); }
    void write(std::uint64_t address);

    /// True if read_promptly() may take the place of request(), while none is under way (PromptMemory).
    bool is_prompt() const { return prompt_ != nullptr && watch_ == nullptr && prompt_->is_prompt(); }
    PromptMemory::Times read_promptly(const std::uint64_t* addresses, unsigned count, std::uint64_t* entries,
                                      std::uint64_t offered);

    /// True if the oldest request under way has been answered.
    bool answered() const { return answered_ > 0; }
    bool answer_is_read() const { return slots_.front().request.command == tlm::TLM_READ_COMMAND; }
    /// Entry k of that answer, zero-extended.
    std::uint64_t entry(unsigned k) const {
        std::uint64_t value = 0;
        copy_entries(k, 1, &value);
        return value;
    }
    /// Copies `count` entries of that answer, from entry `first` on.
    void copy_entries(unsigned first, unsigned count, std::uint64_t* to) const {
        const unsigned char* from = answer() + std::size_t{first} * entry_bytes_;
        for (unsigned k = 0; k < count; ++k, from += entry_bytes_) {
            std::uint64_t value = 0;
            std::memcpy(&value, from, sizeof value);  // the slot has eight bytes after its last entry
            to[k] = value & mask_;
        }
    }
    /// The bytes of that answer.
    const unsigned char* answer() const { return slots_.front().data.data(); }
    void pop_answer() {
        slots_.pop();
        --answered_;
    }

    /// Writes `count` bytes to the memory, wherever the port is joined. Returns false if the memory does not take them,
    /// or then reads as others. A memory that cannot be read is believed.
    bool load(std::uint64_t address, const unsigned char* bytes, unsigned count);
    /// False if the memory can be read and holds other bytes.
    bool holds(std::uint64_t address, const unsigned char* bytes, unsigned count);

    /// Requests made in timed mode; entries read in either mode.
    std::uint64_t requests() const { return requests_; }
    std::uint64_t reads() const { return reads_; }
    unsigned entry_bytes() const { return entry_bytes_; }

    /// Binds the port to a memory (with a socket of that name).
    template <class Memory>
    void bind(Memory& memory) {
        bind(memory, memory);
        interposed_ = false;
        if constexpr (std::is_base_of_v<PromptMemory, Memory>)
            prompt_ = &memory;
    }
    /// Binds it through a module in front of the memory.
    template <class Interposer>
    void bind(Interposer& before, const sc_core::sc_object& memory) {
        socket.bind(before.socket);
        memory_ = &memory;
        interposed_ = true;
    }
    /// The memory that the unit waits for.
    const sc_core::sc_object* memory() const { return memory_; }
    /// There is something else between the port and that memory.
    bool interposed() const { return interposed_; }

    /// Every request from now on is watched; `watch` must outlive the last.
    void watched_by(AnswerWatch& watch) { watch_ = &watch; }
    /// From now on an answer with other bytes than load() has written is an SC_ERROR: debug accesses may lead elsewhere
    /// than transactions.
    void compare_contents() { compares_ = true; }

  private:
    struct Slot {
        MemoryRequest request;
        std::vector<unsigned char> data;
        std::uint64_t watched = 0;
    };

    void read_by_transactions(const std::uint64_t* addresses, unsigned count, std::uint64_t* entries,
                              sc_core::sc_time& delay);
    void check_response(const MemoryRequest& request) const;
    void check_contents(const MemoryRequest& request) const;
    void ask_for_direct_memory(MemoryRequest& request);
    void invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) { direct_bytes_ = 0; }
    void offer(tlm::tlm_command command, const std::uint64_t* addresses, unsigned count);
    tlm::tlm_sync_enum nb_transport_bw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay);

    unsigned entry_bytes_;
    std::uint64_t mask_;
    bool use_direct_memory_;
    std::uint64_t requests_ = 0;
    std::uint64_t reads_ = 0;
    const unsigned char* direct_ = nullptr;
    std::uint64_t direct_start_ = 0;
    // Addresses at which eight bytes may be loaded; requests that reach the table's last few entries are transactions.
    // 0: no DMI.
    std::uint64_t direct_bytes_ = 0;
    std::array<sc_core::sc_time, datapath::most_rectangle_entries + 1> direct_times_;  // by number of entries

    CycleScheduler* clock_ = nullptr;
    CycleProcess* unit_ = nullptr;
    Ring<Slot> slots_;          // the requests under way
    std::size_t answered_ = 0;  // number of these answered: the oldest ones
    bool on_offer_ = false;     // the newest of these is not accepted yet
    const sc_core::sc_object* memory_ = nullptr;
    bool interposed_ = true;
    PromptMemory* prompt_ = nullptr;  // null: a memory that only answers
    AnswerWatch* watch_ = nullptr;
    std::uint64_t loaded_from_ = 0;
    std::vector<unsigned char> loaded_;  // if it compares
    bool compares_ = false;
};

}  // namespace tessera
