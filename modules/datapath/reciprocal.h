#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/datapath/intermediate.h"

namespace tessera::datapath {

/// Seeds for 1/m, m in [1, 2): entry k is 1/m at the middle of the k-th of 128 intervals, 16 fraction bits.
constexpr std::array<std::uint32_t, 128> make_reciprocal_seeds() {
    std::array<std::uint32_t, 128> seeds{};
    for (std::uint32_t k = 0; k < 128; ++k)
        seeds[k] = ((std::uint32_t{1} << 24) + (257 + 2 * k) / 2) / (257 + 2 * k);
    return seeds;
}
inline constexpr auto reciprocal_seeds = make_reciprocal_seeds();

/// Widths in one Newton step; the same in all formats.
struct ReciprocalWidths : Intermediates {
    using Intermediates::Intermediates;
    Width mantissa{"m", 32};
    Width reciprocal{"r", 33};
    Width product{"m * r", 64};
    Width correction{"2 - m * r", 32};
    Width step{"r * (2 - m * r)", 64};
    constexpr auto all() const { return std::array{mantissa, reciprocal, product, correction, step}; }
};
static_assert(fits_every_format<ReciprocalWidths>());

/// 2^63 / m for m in [2^31, 2^32): a value in [2^31, 2^32].
/// Table look-up (relative error under 2^-8), then two Newton steps r = r (2 - m r).
/// Relative error -2^-30.9 to 2^-31 (exhaustive over m once; the tests sample densely).
constexpr std::uint64_t reciprocal(std::uint32_t m) {
    std::uint64_t r = std::uint64_t{reciprocal_seeds[(m >> 24) & 127]} << 16;
    for (int step = 0; step < 2; ++step) {
        const std::uint64_t product = (m * r) >> 32;  // 31 fraction bits, near 1
        const std::uint64_t correction = (std::uint64_t{1} << 32) - product;
        r = (r * correction) >> 31;
    }
    return r;
}

/// Number of leading zeros; value > 0.
constexpr int leading_zeros(std::uint64_t value) {
    return __builtin_clzll(value);
}

}  // namespace tessera::datapath
