#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace tessera {

/// A level over time: the highest level in each of at most 1024 intervals of equal length. The length doubles when the
/// run outgrows them, so that memory and cost do not depend on the length of the run.
class LevelHistory {
  public:
    LevelHistory() { highest_.reserve(most); }

    void set(std::uint64_t cycle, std::uint64_t level) {
        fill(cycle);
        level_ = level;
        highest_.back() = std::max(highest_.back(), level);
    }
    /// Extends the history to the run's end.
    void finish(std::uint64_t cycle) {
        if (cycle > 0)
            fill(cycle - 1);
    }

    std::uint64_t stretch() const { return stretch_; }
    const std::vector<std::uint64_t>& highest() const { return highest_; }

  private:
    static constexpr std::size_t most = 1024;

    void fill(std::uint64_t cycle) {
        while (cycle / stretch_ >= most) {
            for (std::size_t k = 0; k < highest_.size(); k += 2)
                highest_[k / 2] = std::max(highest_[k], k + 1 < highest_.size() ? highest_[k + 1] : 0);
            highest_.resize((highest_.size() + 1) / 2);
            stretch_ *= 2;
        }
        if (highest_.size() <= cycle / stretch_)
            highest_.resize(cycle / stretch_ + 1, level_);
    }

    std::uint64_t stretch_ = 1;
    std::uint64_t level_ = 0;
    std::vector<std::uint64_t> highest_;
};

}  // namespace tessera
