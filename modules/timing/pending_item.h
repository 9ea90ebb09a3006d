#pragma once
#include <cstdint>
#include <utility>

namespace tessera {

/// An item that was offered and not taken: END_REQ is withheld until there is room and its cycle has come.
template <class Item>
class PendingItem {
  public:
    bool empty() const { return item_ == nullptr; }
    /// The item may be taken in `cycle`, if there is room.
    bool due(std::uint64_t cycle) const { return item_ != nullptr && due_ <= cycle; }
    std::uint64_t due_cycle() const { return due_; }

    /// Not when another waits. `item` must stay where it is until taken.
    void hold(Item& item, std::uint64_t due) {
        item_ = &item;
        due_ = due;
    }
    /// Not when empty.
    Item& take() { return *std::exchange(item_, nullptr); }

  private:
    Item* item_ = nullptr;
    std::uint64_t due_ = 0;
};

}  // namespace tessera
