#pragma once
#include <tlm_utils/passthrough_target_socket.h>
#include <cstdint>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/stream/random_stalls.h"
#include "modules/timing.h"
#include "modules/unit/unit.h"

namespace tessera {

/// Off-chip memory, to which the Triangle Queue spills: base protocol, byte addresses from 0, reads and writes.
///
/// nb_transport (timed mode): one channel for both directions, in order of arrival. A request takes
/// ceil(bytes / bandwidth) cycles of the channel and is answered `latency` cycles after its last byte.
/// Capacity: `size` bytes; `buffer` requests waiting, beyond that END_REQ is withheld. Errors: TLM_ADDRESS_ERROR_RESPONSE
/// beyond the size, TLM_COMMAND_ERROR_RESPONSE for anything but read and write.
class OffChipMemory : public Unit {
  public:
    tlm_utils::passthrough_target_socket<OffChipMemory> socket{"socket"};

    /// uncounted: bytes at the end of each request that are the model's own and take no time.
    OffChipMemory(const sc_core::sc_module_name& name, Clock& clock, const OffChipTiming& timing,
                  const StallParameters& stalls, std::uint64_t size, unsigned uncounted);

    std::uint64_t bytes_written() const { return bytes_written_; }
    std::uint64_t bytes_read() const { return bytes_read_; }

    std::string holds() const override {
        return listed(count_of(std::size_t{queued_} + answers_, "request"),
                      at_the_door_ == nullptr ? "" : "one at its door");
    }
    std::uint64_t occupied_cycles() const override { return channel_cycles_; }
    void show(Signals& signals) const override;

  private:
    struct Request {
        tlm::tlm_generic_payload* payload = nullptr;
        std::uint64_t answer_at = 0;
    };

    tlm::tlm_sync_enum nb_transport_fw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                       sc_core::sc_time& delay);
    void step() override;
    void admit(std::uint64_t cycle);
    void serve(tlm::tlm_generic_payload& payload, std::uint64_t cycle);
    void access(tlm::tlm_generic_payload& payload);

    OffChipTiming timing_;
    std::uint64_t size_;
    unsigned uncounted_;
    std::vector<unsigned char> storage_;  // as much as was ever written
    tlm::tlm_generic_payload* at_the_door_ = nullptr;
    std::uint64_t door_opens_ = 0;
    RandomStalls stalls_;
    std::vector<tlm::tlm_generic_payload*> queue_;
    std::size_t queue_first_ = 0;
    std::size_t queued_ = 0;
    std::vector<Request> answer_ring_;
    std::size_t answer_first_ = 0;
    std::size_t answers_ = 0;
    std::uint64_t channel_free_ = 0;
    std::uint64_t channel_cycles_ = 0;
    std::uint64_t last_address_ = 0;  // of the request served last
    bool last_is_write_ = false;
    std::uint64_t bytes_written_ = 0;
    std::uint64_t bytes_read_ = 0;
};

}  // namespace tessera
