#pragma once
#include <cstddef>

#include "modules/datapath/vertex.h"
#include "modules/timing/design.h"
#include "modules/timing/ring.h"

namespace tessera {

/// The Triangle Queue's memory: a ring buffer that doubles when full, so that nothing is allocated once a run has
/// reached its high-water mark.
class TriangleStore {
  public:
    explicit TriangleStore(TriangleOrder order) : order_(order), ring_(1024) {}

    bool empty() const { return ring_.empty(); }
    std::size_t size() const { return ring_.size(); }

    void push(const datapath::Triangle& triangle) {
        if (ring_.full())
            ring_.grow();
        ring_.push(triangle);
    }
    /// Removes the next triangle in order. Must not be empty. The reference is valid until the next push.
    const datapath::Triangle& pop() {
        if (order_ == TriangleOrder::fifo)
            return pop_oldest();
        const datapath::Triangle& newest = ring_.at(ring_.size() - 1);
        ring_.pop_back();
        return newest;
    }

    /// The other end of the store, for spilling.
    void push_oldest(const datapath::Triangle& triangle) {
        if (ring_.full())
            ring_.grow();
        ring_.push_front() = triangle;
    }
    const datapath::Triangle& pop_oldest() {
        const datapath::Triangle& oldest = ring_.front();
        ring_.pop();
        return oldest;
    }

  private:
    TriangleOrder order_;
    Ring<datapath::Triangle> ring_;
};

}  // namespace tessera
