#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/common/distinct_table.h"

namespace tessera {

/// The bits of x, with -0 mapped to +0: equal values have equal bits.
inline std::uint64_t alike_bits(double x) {
    const double positive_zero = x + 0.0;
    std::uint64_t bits;
    std::memcpy(&bits, &positive_zero, sizeof bits);
    return bits;
}

using PositionKey = std::array<std::uint64_t, 3>;
inline PositionKey position_key(glm::dvec3 const& p) {
    return {alike_bits(p.x), alike_bits(p.y), alike_bits(p.z)};
}

/// For every key, the index of the first key equal to it. Linear time; the result depends on the keys only.
/// Takes fewer than 2^31 keys.
template <std::size_t N>
std::vector<std::uint32_t> first_equal(std::vector<std::array<std::uint64_t, N>> const& keys) {
    constexpr std::uint32_t empty = UINT32_MAX;
    std::size_t slots = 16;
    while (slots < 2 * keys.size()) {
        slots *= 2;
    }
    std::vector<std::uint32_t> table(slots, empty);
    std::vector<std::uint32_t> first(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        std::uint64_t hash = 0;
        for (std::uint64_t word : keys[i]) {
            hash = mix_hash(hash, word);
        }
        std::size_t slot = (hash * 0xbf58476d1ce4e5b9u >> 20) & (slots - 1);
        while (table[slot] != empty && keys[table[slot]] != keys[i]) {
            slot = (slot + 1) & (slots - 1);
        }
        if (table[slot] == empty) {
            table[slot] = static_cast<std::uint32_t>(i);
        }
        first[i] = table[slot];
    }
    return first;
}

}  // namespace tessera
