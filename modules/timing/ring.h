#pragma once
#include <cstddef>
#include <utility>
#include <vector>

namespace tessera {

/// A ring buffer of fixed capacity, oldest item first. Allocates only when constructed or grown. A popped item stays in
/// its place until another is pushed there, so that storage owned by items is reused. An empty ring restarts at its
/// first place, so that a rarely used one stays in the host's cache.
template <class Item>
class Ring {
  public:
    explicit Ring(std::size_t capacity = 0) : items_(capacity), capacity_(capacity) {}

    bool empty() const { return size_ == 0; }
    bool full() const { return size_ == capacity_; }
    std::size_t size() const { return size_; }
    std::size_t capacity() const { return capacity_; }

    /// Item k, counted from the oldest. at(size()) is the place of the next push.
    Item& at(std::size_t k) { return items_[place(k)]; }
    const Item& at(std::size_t k) const { return items_[place(k)]; }
    Item& front() { return items_[first_]; }
    const Item& front() const { return items_[first_]; }
    /// The item pushed last, even if it has been popped since.
    Item& back() { return items_[last_]; }
    const Item& back() const { return items_[last_]; }

    /// Must not be full. Returns the new item with the old contents of its place, which the caller must overwrite.
    Item& push() {
        ++size_;
        last_ = next_;
        next_ = next_ + 1 == capacity_ ? 0 : next_ + 1;
        return items_[last_];
    }
    void push(const Item& item) { push() = item; }
    /// Must not be empty.
    void pop() {
        first_ = first_ + 1 == capacity_ ? 0 : first_ + 1;
        if (--size_ == 0)
            first_ = next_ = 0;
    }

    /// At the other ends: push_front() adds a new oldest item, pop_back() removes the newest.
    Item& push_front() {
        first_ = (first_ == 0 ? capacity_ : first_) - 1;
        ++size_;
        return items_[first_];
    }
    void pop_back() {
        next_ = (next_ == 0 ? capacity_ : next_) - 1;
        if (--size_ == 0)
            first_ = next_ = 0;
    }

    /// Doubles the capacity, at least to one; the items keep their order.
    void grow() {
        std::vector<Item> larger(capacity_ == 0 ? 1 : 2 * capacity_);
        for (std::size_t k = 0; k < size_; ++k)
            larger[k] = std::move(at(k));
        items_.swap(larger);
        capacity_ = items_.size();
        first_ = 0;
        next_ = size_ == capacity_ ? 0 : size_;
        last_ = size_ == 0 ? 0 : size_ - 1;
    }

  private:
    std::size_t place(std::size_t k) const {
        const std::size_t sum = first_ + k;
        return sum < capacity_ ? sum : sum - capacity_;
    }

    std::vector<Item> items_;
    std::size_t capacity_;
    std::size_t first_ = 0;
    std::size_t next_ = 0;  // place of the next push
    std::size_t last_ = 0;
    std::size_t size_ = 0;
};

}  // namespace tessera
