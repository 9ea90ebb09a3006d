#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "golden/golden_model.h"
#include "golden/height_tests/summed_height_test.h"

/// Maps of all shapes, and random numbers to fill them, for the golden model's tests.
namespace tessera::golden::testing {

/// A seeded generator that gives the same numbers with every standard library.
class Random {
  public:
    double real(double low, double high) { return low + (high - low) * static_cast<double>(bits_()) * 0x1p-64; }
    std::int64_t integer(std::int64_t low, std::int64_t high) {
        return low + static_cast<std::int64_t>(bits_() % static_cast<std::uint64_t>(high - low + 1));
    }
    /// A multiple of 1/4096, the hardware's texture format.
    double grid(double low, double high) { return std::floor(real(low, high) * 4096) / 4096; }
    glm::dvec3 unit() {
        for (;;) {
            const glm::dvec3 v{real(-1, 1), real(-1, 1), real(-1, 1)};  // braces fix the order
            if (glm::length(v) > 0.1 && glm::length(v) < 1)
                return v / glm::length(v);
        }
    }

  private:
    std::mt19937_64 bits_{20000821};
};

inline std::vector<double> constant_codes(int width, int height, double code) {
    return std::vector<double>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), code);
}

inline std::vector<double> random_codes(int width, int height, Random& random) {
    std::vector<double> codes = constant_codes(width, height, 0);
    for (double& code : codes)
        code = static_cast<double>(random.integer(0, 65535));
    return codes;
}

inline void set_summed_height(Map& map, double threshold, bool area = false) {
    map.set_height_test(std::make_shared<SummedHeightTest>(threshold, area));
}

inline const std::array<AddressMode, 2> both_modes{AddressMode::clamp, AddressMode::repeat};
inline const std::array<std::pair<int, int>, 5> sizes{{{1, 1}, {1, 6}, {6, 1}, {12, 19}, {336, 459}}};

}  // namespace tessera::golden::testing
