#pragma once
#include <array>
#include <cstdint>
#include <tlm>

#include "modules/datapath/rectangle.h"

namespace tessera {

/// Makes one read of several entries at addresses of their own: a rectangle's corners, which occupy the port one after
/// another, are one transaction (a handshake for each would cost more host time than everything else together). The
/// data array holds the entries in the order of `address`; data length = count * entry bytes; the payload's own
/// address is that of the first. Without the extension a read is an ordinary one.
struct GatherExtension : tlm::tlm_extension<GatherExtension> {
    unsigned count = 0;
    std::array<std::uint64_t, datapath::RectangleReads::most> address{};

    tlm_extension_base* clone() const override { return new GatherExtension(*this); }
    void copy_from(const tlm_extension_base& other) override {
        *this = static_cast<const GatherExtension&>(other);
    }
};

}  // namespace tessera
