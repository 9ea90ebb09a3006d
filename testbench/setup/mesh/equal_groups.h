#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/common/distinct_table.h"

namespace tessera {

using PositionKey = std::array<std::uint64_t, 3>;
inline PositionKey position_key(const glm::dvec3& p) {
    return {alike_bits(p.x), alike_bits(p.y), alike_bits(p.z)};
}

/// For every key, the index of the first key equal to it. Linear time; the result depends on the keys only.
/// Takes fewer than 2^31 keys.
template <std::size_t N>
std::vector<std::uint32_t> first_equal(const std::vector<std::array<std::uint64_t, N>>& keys) {
    const auto hash_of = [&](std::size_t i) {
        std::uint64_t hash = 0;
        for (const std::uint64_t word : keys[i])
            hash = mix_hash(hash, word);
        return hash;
    };
    DistinctTable table;
    std::vector<std::uint32_t> distinct, first;
    first.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const std::uint32_t number = table.number_of(
            hash_of(i), [&](std::uint32_t k) { return keys[distinct[k]] == keys[i]; },
            [&](std::uint32_t k) { return hash_of(distinct[k]); });
        if (number == distinct.size())
            distinct.push_back(static_cast<std::uint32_t>(i));
        first.push_back(distinct[number]);
    }
    return first;
}

}  // namespace tessera
