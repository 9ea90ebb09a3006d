#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "testbench/common/hash.h"

namespace tessera {

/// Numbers distinct items from 0 in order of arrival. The caller stores the items. Open addressing, four bytes per
/// slot, at most half of the slots used. Fewer than 2^32 - 1 items.
class DistinctTable {
  public:
    /// Returns the number of the known item with this hash for which same(number) is true. If there is none, adds one
    /// and returns its number, the previous size(). hash_of(number): the hash of a known item.
    template <class Same, class HashOf>
    std::uint32_t number_of(std::uint64_t hash, const Same& same, const HashOf& hash_of) {
        if (2 * (size_ + 1) > slots_.size())
            grow(hash_of);
        std::uint32_t& slot = find(hash, same);
        if (slot == empty)
            slot = static_cast<std::uint32_t>(size_++);
        return slot;
    }

    std::size_t size() const { return size_; }

    /// Removes all items and reserves space for `expected` items.
    void clear(std::size_t expected) {
        std::size_t slots = 16;
        while (slots < 2 * (expected + 1))
            slots *= 2;
        slots_.assign(slots, empty);
        size_ = 0;
    }

  private:
    static constexpr std::uint32_t empty = UINT32_MAX;

    template <class Same>
    std::uint32_t& find(std::uint64_t hash, const Same& same) {
        const std::size_t mask = slots_.size() - 1;
        std::size_t place = static_cast<std::size_t>(hash * 0xbf58476d1ce4e5b9u >> 8) & mask;
        while (slots_[place] != empty && !same(slots_[place]))
            place = (place + 1) & mask;
        return slots_[place];
    }

    template <class HashOf>
    void grow(const HashOf& hash_of) {
        slots_.assign(2 * slots_.size(), empty);
        for (std::uint32_t number = 0; number < size_; ++number)
            find(hash_of(number), [](std::uint32_t) { return false; }) = number;
    }

    std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(1024, empty);
    std::size_t size_ = 0;
};

}  // namespace tessera
