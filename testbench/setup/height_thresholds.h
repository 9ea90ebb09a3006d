#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

namespace tessera {

/// The thresholds of all height tests, by their keys, in the keys' units. Each test's host part declares its own
/// (HeightTestHost::thresholds).
class HeightThresholds {
  public:
    /// Each at its default.
    HeightThresholds();

    /// Throws std::out_of_range if no height test has this key.
    double& operator[](std::string_view key) { return values_.at(index_of(key)); }
    double operator[](std::string_view key) const { return values_.at(index_of(key)); }

  private:
    static std::size_t index_of(std::string_view key);

    std::vector<double> values_;  // in the order of the declarations
};

}  // namespace tessera
