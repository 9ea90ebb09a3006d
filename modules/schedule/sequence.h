#pragma once
#include <cstddef>
#include <cstdint>

#include "modules/timing/ring.h"

namespace tessera::schedule {

/// A list that grows at its end and is forgotten from its beginning; items keep their numbers.
template <class Item>
class Sequence {
  public:
    void add(const Item& item) {
        if (items_.full())
            items_.grow();
        items_.push(item);
    }
    /// The number of the first item that has not been forgotten, and of the next.
    std::uint64_t first() const { return first_; }
    std::uint64_t count() const { return first_ + items_.size(); }
    const Item& operator[](std::uint64_t number) const { return items_.at(static_cast<std::size_t>(number - first_)); }
    /// Items before this one are not asked for any more.
    void forget_before(std::uint64_t number) {
        for (; first_ < number; ++first_)
            items_.pop();
    }

  private:
    Ring<Item> items_{64};
    std::uint64_t first_ = 0;
};

}  // namespace tessera::schedule
