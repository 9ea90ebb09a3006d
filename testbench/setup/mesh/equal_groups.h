#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/common/distinct_table.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

using PositionKey = std::array<std::uint64_t, 3>;
inline PositionKey position_key(const glm::dvec3& p) {
    return {alike_bits(p.x), alike_bits(p.y), alike_bits(p.z)};
}

/// For each of `count` keys, the index of the first key equal to it; key_of(index): an array of 64 bit words. Linear time;
/// the result depends on the keys only. Takes fewer than 2^31 keys.
template <class KeyOf>
std::vector<std::uint32_t> first_equal_of(std::size_t count, KeyOf key_of) {
    const auto hash_of = [&](std::size_t i) {
        std::uint64_t hash = 0;
        for (const std::uint64_t word : key_of(i))
            hash = mix_hash(hash, word);
        return hash;
    };
    DistinctTable table;
    std::vector<std::uint32_t> distinct, first;
    first.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t number = table.number_of(
            hash_of(i), [&](std::uint32_t k) { return key_of(distinct[k]) == key_of(i); },
            [&](std::uint32_t k) { return hash_of(distinct[k]); });
        if (number == distinct.size())
            distinct.push_back(static_cast<std::uint32_t>(i));
        first.push_back(distinct[number]);
    }
    return first;
}
template <std::size_t N>
std::vector<std::uint32_t> first_equal(const std::vector<std::array<std::uint64_t, N>>& keys) {
    return first_equal_of(keys.size(), [&](std::size_t i) -> const std::array<std::uint64_t, N>& { return keys[i]; });
}

/// The same for items that have the keys key_of(item).
template <class Items, class KeyOf>
std::vector<std::uint32_t> first_equal(const Items& items, KeyOf key_of) {
    std::vector<decltype(key_of(*items.begin()))> keys;
    keys.reserve(items.size());
    for (const auto& item : items)
        keys.push_back(key_of(item));
    return first_equal(keys);
}

/// The same for vertices by their positions.
inline std::vector<std::uint32_t> first_at_position(const std::vector<BaseVertex>& vertices) {
    return first_equal(vertices, [](const BaseVertex& vertex) { return position_key(vertex.position); });
}

}  // namespace tessera
