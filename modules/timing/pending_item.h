#pragma once
#include <cstdint>
#include <utility>

namespace tessera {

/// An item that was offered and not yet accepted: END_REQ is withheld until there is room and its cycle is reached.
template <class Item>
class PendingItem {
  public:
    bool empty() const { return item_ == nullptr; }
    /// True if the item may be accepted in `cycle`, provided there is room.
    bool due(std::uint64_t cycle) const { return item_ != nullptr && due_ <= cycle; }
    std::uint64_t due_cycle() const { return due_; }

    /// No other item may be waiting. `item` must stay in place until accepted.
    void hold(Item& item, std::uint64_t due) {
        item_ = &item;
        due_ = due;
    }
    /// Must not be empty.
    Item& take() { return *std::exchange(item_, nullptr); }

  private:
    Item* item_ = nullptr;
    std::uint64_t due_ = 0;
};

}  // namespace tessera
