#pragma once
#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <cstdint>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/sockets/memory_request.h"

namespace tessera {

/// The read checks' result.
struct ReadResult {
    std::uint64_t entries = 0;  ///< compared
    std::uint64_t wrong = 0;    ///< different from the memory's
    std::uint64_t missed = 0;   ///< read by a unit or cache, but not compared
    std::string first_wrong;    ///< empty: none

    bool empty() const { return entries == 0; }
    bool passed() const { return !empty() && wrong == 0 && missed == 0; }
};

/// Inserted at a unit's memory port. Forwards all transactions and compares the data of each read with the memory's
/// contents at the requested addresses (debug transport), which detects a flipped bit even if no decision changes.
/// Denies DMI. Optional: timed mode takes a sixth longer; functional mode, whose reads then use transactions, three
/// times as long.
class ReadCheck : public sc_core::sc_module {
  public:
    tlm_utils::passthrough_target_socket<ReadCheck, 32, MemoryProtocol> socket{"socket"};
    tlm_utils::simple_initiator_socket<ReadCheck, 32, MemoryProtocol> to_memory{"to_memory"};

    /// `port`: for messages.
    ReadCheck(const sc_core::sc_module_name& name, std::string port);

    const ReadResult& result() const { return result_; }
    const std::string& port() const { return port_; }

  private:
    /// A pending request and its copy, which no module downstream can modify.
    struct Asked {
        const MemoryRequest* request = nullptr;
        MemoryRequest copy;
    };

    void b_transport(MemoryRequest& request, sc_core::sc_time& delay);
    tlm::tlm_sync_enum nb_transport_fw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay);
    tlm::tlm_sync_enum nb_transport_bw(MemoryRequest& request, tlm::tlm_phase& phase, sc_core::sc_time& delay);
    unsigned transport_dbg(MemoryRequest& request);
    void compare(const MemoryRequest& asked, const MemoryRequest& answer);

    std::string port_;
    std::vector<Asked> under_way_;
    ReadResult result_;
};

}  // namespace tessera
