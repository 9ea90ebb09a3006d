#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::schedule {

using Cycle = std::uint64_t;

/// The last so many of a sequence, by their numbers.
template <class Item>
class Latest {
  public:
    /// most: at least so many.
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

/// In which cycle each of the last items did something, by the item's number. Before the first item: cycle 0.
class History {
  public:
    /// depth: how far back from the next item it is asked.
    explicit History(std::size_t depth) : cycles_(depth) {}

    void add(Cycle cycle) { cycles_[count_++] = cycle; }
    Cycle operator[](std::uint64_t item) const { return cycles_[item]; }
    std::uint64_t count() const { return count_; }

  private:
    Latest<Cycle> cycles_;
    std::uint64_t count_ = 0;
};

}  // namespace tessera::schedule
