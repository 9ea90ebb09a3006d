#pragma once
#include <cstddef>
#include <vector>

#include "modules/datapath/vertex.h"
#include "modules/design.h"

namespace tessera {

/// The Triangle Queue's memory: a ring that doubles when it is full, so that no triangle is allocated for once a run
/// has reached its high-water mark.
class TriangleStore {
  public:
    explicit TriangleStore(TriangleOrder order) : order_(order), ring_(1024) {}

    bool empty() const { return size_ == 0; }
    std::size_t size() const { return size_; }

    void push(const datapath::Triangle& triangle) {
        if (size_ == ring_.size())
            grow();
        ring_[(first_ + size_) & (ring_.size() - 1)] = triangle;
        ++size_;
    }

    /// The next triangle in order; the store must not be empty. The reference holds until the next push.
    const datapath::Triangle& pop() {
        --size_;
        if (order_ == TriangleOrder::lifo)
            return ring_[(first_ + size_) & (ring_.size() - 1)];
        const std::size_t place = first_;
        first_ = (first_ + 1) & (ring_.size() - 1);
        return ring_[place];
    }

    /// Beside the order: the other end of what is stored, for spilling.
    void push_oldest(const datapath::Triangle& triangle) {
        if (size_ == ring_.size())
            grow();
        first_ = (first_ - 1) & (ring_.size() - 1);
        ring_[first_] = triangle;
        ++size_;
    }
    const datapath::Triangle& pop_oldest() {
        const std::size_t place = first_;
        first_ = (first_ + 1) & (ring_.size() - 1);
        --size_;
        return ring_[place];
    }

  private:
    void grow() {
        std::vector<datapath::Triangle> larger(2 * ring_.size());
        for (std::size_t k = 0; k < size_; ++k)
            larger[k] = ring_[(first_ + k) & (ring_.size() - 1)];
        ring_.swap(larger);
        first_ = 0;
    }

    TriangleOrder order_;
    std::vector<datapath::Triangle> ring_;  // a power of two
    std::size_t first_ = 0;
    std::size_t size_ = 0;
};

}  // namespace tessera
