#include "modules/device/dma_channel.h"

#include <algorithm>

namespace tessera {

void DmaChannel::synchronise() {
    if (keeper_.get_local_time() != sc_core::SC_ZERO_TIME)
        keeper_.sync();
    else
        keeper_.reset();
}

void DmaChannel::set_local_time(const sc_core::sc_time& offset) {
    keeper_.set(offset);
    if (!loosely_timed_ || keeper_.need_sync())
        synchronise();
}

bool DmaChannel::transfer(tlm::tlm_command command, std::uint64_t address, unsigned char* data, std::uint64_t bytes) {
    while (bytes > 0) {
        const std::uint64_t length = std::min<std::uint64_t>(bytes, burst_bytes_ - address % burst_bytes_);
        tlm::tlm_generic_payload burst;
        burst.set_command(command);
        burst.set_address(address);
        burst.set_data_ptr(data);
        burst.set_data_length(static_cast<unsigned>(length));
        burst.set_streaming_width(static_cast<unsigned>(length));
        sc_core::sc_time delay = local_time();
        const std::uint64_t watched = watch_.begin(command, address, delay);
        bus_->b_transport(burst, delay);
        watch_.end(watched);
        set_local_time(delay);
        if (!burst.is_response_ok()) {
            failed_at_ = address;
            return false;
        }
        address += length;
        data += length;
        bytes -= length;
    }
    return true;
}

}  // namespace tessera
