#pragma once
#include <cstdint>

namespace tessera {

/// part / whole; 0 if whole is 0.
inline double ratio(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace tessera
