#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::schedule {

using Cycle = std::uint64_t;

/// The cycle of some event for each of the last items, by item number; cycle 0 for numbers before the first item.
class History {
  public:
    /// depth: the largest distance back from the next item that is read.
    explicit History(std::size_t depth) {
        std::size_t size = 1;
        while (size < depth)
            size *= 2;
        cycles_.resize(size);
    }

    void add(Cycle cycle) { cycles_[count_++ & (cycles_.size() - 1)] = cycle; }
    Cycle operator[](std::uint64_t item) const { return cycles_[item & (cycles_.size() - 1)]; }
    std::uint64_t count() const { return count_; }

  private:
    std::vector<Cycle> cycles_;  // a power of two
    std::uint64_t count_ = 0;
};

}  // namespace tessera::schedule
