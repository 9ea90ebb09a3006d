#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <cstdint>
#include <cstring>
#include <systemc>
#include <tlm>

namespace tessera {

/// A unit's read port on a table: DMI where the memory grants it and the unit may use it, else b_transport; the same
/// values, the same added time and the same counts either way. Every response is checked: one that is not OK is an
/// SC_ERROR that names the port, the address and the response.
class MemoryPort {
  public:
    tlm_utils::simple_initiator_socket<MemoryPort> socket;

    /// entry_bytes: 1 to 8.
    MemoryPort(const char* name, unsigned entry_bytes, bool use_direct_memory);

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

    std::uint64_t reads() const { return reads_; }
    std::uint64_t bytes_read() const { return reads_ * entry_bytes_; }
    unsigned entry_bytes() const { return entry_bytes_; }

  private:
    std::uint64_t read_by_transaction(std::uint64_t address, sc_core::sc_time& delay);
    void ask_for_direct_memory();
    void invalidate_direct_mem_ptr(sc_dt::uint64 start, sc_dt::uint64 end);

    unsigned entry_bytes_;
    std::uint64_t mask_;
    bool use_direct_memory_;
    std::uint64_t reads_ = 0;
    const unsigned char* direct_ = nullptr;
    std::uint64_t direct_start_ = 0;
    // Addresses at which eight bytes may be loaded; the table's last few entries are read by transaction. 0: no DMI.
    std::uint64_t direct_bytes_ = 0;
    sc_core::sc_time direct_time_;
    tlm::tlm_generic_payload payload_;
};

}  // namespace tessera
