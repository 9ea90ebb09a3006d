#pragma once
#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <array>
#include <cstdint>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "modules/datapath/rectangle.h"

namespace tessera {

/// What read checks found.
struct ReadResult {
    std::uint64_t entries = 0;  ///< compared
    std::uint64_t wrong = 0;    ///< not what the memory holds
    std::string first_wrong;    ///< empty: none

    bool passed() const { return wrong == 0; }
};

/// Stands before a unit's memory port, passes everything on, and compares what each read brought with what the memory
/// holds at the addresses that were asked for (debug transport). So a flipped bit is found even where it changes no
/// decision. Denies DMI. Only in runs that ask for it: timed mode takes a sixth longer, functional mode, whose reads then
/// go by transaction, three times as long.
class ReadCheck : public sc_core::sc_module {
  public:
    tlm_utils::passthrough_target_socket<ReadCheck> socket{"socket"};
    tlm_utils::simple_initiator_socket<ReadCheck> to_memory{"to_memory"};

    /// `port`: for messages.
    ReadCheck(const sc_core::sc_module_name& name, std::string port);

    const ReadResult& result() const { return result_; }

  private:
    using Payload = tlm::tlm_generic_payload;
    /// What was asked for, before anyone downstream can touch it.
    struct Asked {
        const Payload* payload = nullptr;
        unsigned count = 0;
        std::array<std::uint64_t, datapath::RectangleReads::most> address{};
    };

    void b_transport(Payload& payload, sc_core::sc_time& delay);
    tlm::tlm_sync_enum nb_transport_fw(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay);
    tlm::tlm_sync_enum nb_transport_bw(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay);
    unsigned transport_dbg(Payload& payload);
    static Asked asked_by(const Payload& payload);
    void compare(const Asked& asked, const Payload& payload);

    std::string port_;
    std::vector<Asked> under_way_;
    ReadResult result_;
};

}  // namespace tessera
