#pragma once
#include <cstdint>
#include <systemc>

#include "modules/memories/channel.h"
#include "modules/memories/memory_server.h"
#include "modules/memories/storage.h"

namespace tessera {

/// Off-chip memory, to which the Triangle Queue spills: byte addresses from 0, reads and writes.
///
/// Timing: channel.h, shared with tables behind caches. Busy: while one of its own requests is on the channel.
/// Utilisation: that of the channel, including all its other users.
/// Capacity: `size` bytes. Errors: TLM_ADDRESS_ERROR_RESPONSE beyond the size, TLM_COMMAND_ERROR_RESPONSE for any
/// command other than read and write.
class OffChipMemory : public MemoryServer {
  public:
    /// uncounted: bytes at the end of each request that exist only in the model and take no time.
    OffChipMemory(const sc_core::sc_module_name& name, CycleScheduler& clock, const OffChipTiming& timing,
                  const StallParameters& stalls, std::uint64_t size, unsigned uncounted);

    std::uint64_t bytes_written() const { return bytes_written_; }
    std::uint64_t bytes_read() const { return bytes_read_; }

    std::uint64_t occupied_cycles() const override { return channel_.occupied_cycles(); }
    void trace_signals(Signals& signals) const override;

    Channel& channel() { return channel_; }

  private:
    std::uint64_t ready(const MemoryRequest&) const override { return channel_.ready(); }
    std::uint64_t serve(MemoryRequest& request, std::uint64_t cycle) override;
    bool busy(std::uint64_t cycle) const override { return busy_until_ > cycle; }
    void b_transport(int id, MemoryRequest& request, sc_core::sc_time& delay) override;
    unsigned transport_dbg(int, MemoryRequest& request) override { return move(storage_, request); }
    void count_access(MemoryRequest& request);
    unsigned counted(const MemoryRequest& request) const;

    Storage storage_;
    Channel channel_;
    unsigned uncounted_;
    std::uint64_t busy_until_ = 0;
    std::uint64_t last_address_ = 0;  // of the request served last
    bool last_is_write_ = false;
    std::uint64_t bytes_written_ = 0;
    std::uint64_t bytes_read_ = 0;
};

}  // namespace tessera
