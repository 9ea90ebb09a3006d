#pragma once
#include <cstdint>

#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Bytes of an entry of `bits` bits: packed, so that the bytes in reports are those of a real design.
constexpr std::uint32_t entry_bytes(int bits) {
    return static_cast<std::uint32_t>((bits + 7) / 8);
}

/// A normal map's entry: three signed components of `bits` bits each, packed, x lowest. bits <= 21.
constexpr std::uint64_t pack_normal(const Direction& n, int bits) {
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    return (static_cast<std::uint64_t>(n.x) & mask) | (static_cast<std::uint64_t>(n.y) & mask) << bits |
           (static_cast<std::uint64_t>(n.z) & mask) << (2 * bits);
}
constexpr Direction unpack_normal(std::uint64_t entry, int bits) {
    const auto component = [&](int place) {
        const auto at_top = static_cast<std::int64_t>(entry << (64 - bits * (place + 1)));
        return static_cast<std::int32_t>(at_top >> (64 - bits));
    };
    return {component(0), component(1), component(2)};
}

}  // namespace tessera::datapath
