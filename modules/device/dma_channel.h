#pragma once
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/tlm_quantumkeeper.h>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <tlm>

#include "modules/sockets/answer_watch.h"

namespace tessera {

/// A thread's transfers over the device's bus master socket.
///
/// Bursts: at most `burst_bytes` long, none across a multiple of it; one at a time.
/// Timing: the delays that the bus annotates. Loosely timed, the thread runs ahead of simulated time by at most the
///         global quantum; otherwise it waits for each burst's delay to pass.
class DmaChannel {
  public:
    using Socket = tlm::tlm_base_initiator_socket<32>;

    /// burst_bytes: a power of two. limit: for an answer (AnswerWatch).
    DmaChannel(const char* name, Socket& bus, unsigned burst_bytes, bool loosely_timed, const sc_core::sc_time& limit)
        : watch_(name, bus.name(), limit), bus_(bus), burst_bytes_(burst_bytes), loosely_timed_(loosely_timed) {}

    /// Returns false after a response other than OK to the burst at failed_at(); no further burst is sent.
    bool read(std::uint64_t address, unsigned char* to, std::uint64_t bytes) {
        return transfer(tlm::TLM_READ_COMMAND, address, to, bytes);
    }
    bool write(std::uint64_t address, unsigned char* from, std::uint64_t bytes) {
        return transfer(tlm::TLM_WRITE_COMMAND, address, from, bytes);
    }
    std::uint64_t failed_at() const { return failed_at_; }

    /// The thread's local time, as an offset from simulated time.
    sc_core::sc_time local_time() const { return keeper_.get_local_time(); }
    void set_local_time(const sc_core::sc_time& offset);
    /// Waits until simulated time has reached the thread's local time. Call before any wait for an event.
    void synchronise();
    /// Call while no transfer is under way.
    void rest() { watch_.rest(); }

  private:
    bool transfer(tlm::tlm_command command, std::uint64_t address, unsigned char* data, std::uint64_t bytes);

    AnswerWatch watch_;
    Socket& bus_;
    unsigned burst_bytes_;
    bool loosely_timed_;
    tlm_utils::tlm_quantumkeeper keeper_;
    std::uint64_t failed_at_ = 0;
};

}  // namespace tessera
