#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::schedule {

using Cycle = std::uint64_t;

/// The last items of a sequence, accessed by number.
template <class Item>
class Latest {
  public:
    /// most: the least number of items that are kept.
    explicit Latest(std::size_t most) {
        std::size_t size = 1;
        while (size < most)
            size *= 2;
        items_.resize(size);
        mask_ = size - 1;
    }
    Item& operator[](std::uint64_t number) { return items_[number & mask_]; }
    const Item& operator[](std::uint64_t number) const { return items_[number & mask_]; }

  private:
    std::vector<Item> items_;
    std::uint64_t mask_ = 0;
};

/// The cycle of some event for each of the last items, by item number; cycle 0 for numbers before the first item.
class History {
  public:
    /// depth: the largest distance back from the next item that is read.
    explicit History(std::size_t depth) : cycles_(depth) {}

    void add(Cycle cycle) { cycles_[count_++] = cycle; }
    Cycle operator[](std::uint64_t item) const { return cycles_[item]; }
    std::uint64_t count() const { return count_; }

  private:
    Latest<Cycle> cycles_;
    std::uint64_t count_ = 0;
};

}  // namespace tessera::schedule
