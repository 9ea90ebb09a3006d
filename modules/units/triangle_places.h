#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "modules/datapath/vertex.h"
#include "modules/timing/ring.h"

namespace tessera {

/// A store of triangles that can be removed in any order, each by its place. A triangle stays in its place until it is
/// released. Places are reused in order of release, so that triangles that leave first in first out lie consecutively.
class TrianglePlaces {
  public:
    std::uint32_t put(const datapath::Triangle& triangle) {
        if (unused_.empty())
            grow();
        const std::uint32_t place = unused_.front();
        unused_.pop();
        at(place) = triangle;
        ++taken_;
        return place;
    }
    datapath::Triangle& at(std::uint32_t place) { return (*blocks_[place / block])[place % block]; }
    void release(std::uint32_t place) {
        unused_.push(place);
        --taken_;
    }
    bool empty() const { return taken_ == 0; }

  private:
    static constexpr std::uint32_t block = 1024;

    /// Doubles the number of places.
    void grow() {
        const std::size_t more = blocks_.empty() ? 1 : blocks_.size();
        for (std::size_t k = 0; k < more; ++k) {
            const auto first = static_cast<std::uint32_t>(blocks_.size()) * block;
            blocks_.push_back(std::make_unique<std::array<datapath::Triangle, block>>());
            while (unused_.capacity() < blocks_.size() * block)
                unused_.grow();
            for (std::uint32_t place = first; place < first + block; ++place)
                unused_.push(place);
        }
    }

    std::vector<std::unique_ptr<std::array<datapath::Triangle, block>>> blocks_;
    Ring<std::uint32_t> unused_;
    std::size_t taken_ = 0;
};

}  // namespace tessera
