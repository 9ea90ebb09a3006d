#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace tessera {

/// Kinds of faults in a transaction: stream_fault.h, memory_fault.h.
enum class FaultKind {
    bit_flip,
    dropped,
    doubled,
    reordered,
    back_pressure_ignored,
    request_before_end,
    end_request_doubled,
    address_flip,
    error_response,
    response_lost,
    response_doubled,
    response_early,
    response_reordered,
};

/// Kinds that need a transaction that is not accepted at once.
constexpr bool strikes_held_back(FaultKind kind) {
    return kind == FaultKind::back_pressure_ignored || kind == FaultKind::request_before_end ||
           kind == FaultKind::response_early;
}

/// One injected fault, in one transaction of a run.
struct Fault {
    FaultKind kind = FaultKind::dropped;
    std::string place;  ///< an output or a memory port, without the machine's name: displace_vertex.to_transform
    std::uint64_t transaction =
        1;                  ///< counted from 1 at the place; for some kinds among those held back (strikes_held_back)
    std::uint64_t bit = 0;  ///< with bit_flip of the payload, with address_flip of the address
};

/// A run's fault: selects the faulty transaction, and records whether it occurred.
class FaultTrigger {
  public:
    explicit FaultTrigger(Fault fault) : fault_(std::move(fault)) {}

    const Fault& fault() const { return fault_; }
    FaultKind kind() const { return fault_.kind; }

    /// Call for each transaction to which the fault's kind applies. Returns true for the faulty one.
    bool strikes() { return ++seen_ == fault_.transaction; }
    bool injected() const { return seen_ >= fault_.transaction; }

    /// Sets whether the faulty transaction is being held until the next one has been sent.
    void wait_for_next(bool waits) { waits_for_next_ = waits; }
    bool waits_for_next() const { return waits_for_next_; }

    /// Throws std::out_of_range if the transaction lacks the fault's bit.
    void require_bit(bool exists) const {
        if (!exists)
            throw std::out_of_range("the transaction at " + fault_.place + " has no bit " + std::to_string(fault_.bit));
    }

  private:
    Fault fault_;
    std::uint64_t seen_ = 0;
    bool waits_for_next_ = false;
};

}  // namespace tessera
