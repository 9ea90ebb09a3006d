#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::schedule {

using Cycle = std::uint64_t;

/// At least `least`.
inline std::size_t power_of_two(std::size_t least) {
    std::size_t power = 1;
    while (power < least)
        power *= 2;
    return power;
}

/// In which cycle each of the last items did something, by the item's number. Before the first item: cycle 0.
class History {
  public:
    /// depth: how far back from the next item it is asked.
    explicit History(std::size_t depth) : cycles_(power_of_two(depth)), mask_(cycles_.size() - 1) {}

    void add(Cycle cycle) { cycles_[count_++ & mask_] = cycle; }
    Cycle operator[](std::uint64_t item) const { return cycles_[item & mask_]; }
    std::uint64_t count() const { return count_; }

  private:
    std::vector<Cycle> cycles_;
    std::uint64_t mask_ = 0;
    std::uint64_t count_ = 0;
};

}  // namespace tessera::schedule
