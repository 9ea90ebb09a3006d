#pragma once
#include <cstddef>
#include <cstdint>

#include "modules/timing/ring.h"

namespace tessera::schedule {

/// A list that grows at its end and is discarded from its beginning. Items keep their numbers.
template <class Item>
class Sequence {
  public:
    void add(const Item& item) {
        if (items_.full())
            items_.grow();
        items_.push(item);
    }
    /// The numbers of the first item still in the list, and of the next item to be added.
    std::uint64_t first() const { return first_; }
    std::uint64_t count() const { return first_ + items_.size(); }
    const Item& operator[](std::uint64_t number) const { return items_.at(static_cast<std::size_t>(number - first_)); }
    /// Discards the items before this one.
    void forget_before(std::uint64_t number) {
        for (; first_ < number; ++first_)
            items_.pop();
    }

  private:
    Ring<Item> items_{64};
    std::uint64_t first_ = 0;
};

}  // namespace tessera::schedule
