#pragma once
#include <algorithm>
#include <tlm>

namespace tessera {

/// True if every byte of the data is enabled. A pattern of byte enables that is shorter than the data repeats; what it
/// has beyond the data does not count.
inline bool all_bytes_enabled(const tlm::tlm_generic_payload& payload) {
    const unsigned char* const enables = payload.get_byte_enable_ptr();
    const unsigned length = std::min(payload.get_byte_enable_length(), payload.get_data_length());
    return enables == nullptr || (length > 0 && std::all_of(enables, enables + length, [](unsigned char enable) {
                                      return enable == TLM_BYTE_ENABLED;
                                  }));
}

/// True if addresses repeat within the data. A streaming width of 0, which the standard forbids and some initiators
/// leave, counts as the data's length.
inline bool is_stream(const tlm::tlm_generic_payload& payload) {
    return payload.get_streaming_width() != 0 && payload.get_streaming_width() < payload.get_data_length();
}

}  // namespace tessera
