#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "modules/datapath/format.h"
#include "modules/datapath/intermediate.h"
#include "modules/datapath/multiplications.h"
#include "modules/datapath/reciprocal.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Largest r with r * r <= value.
constexpr std::uint64_t integer_square_root(std::uint64_t value) {
    std::uint64_t low = 0;
    std::uint64_t high = std::uint64_t{1} << 32;
    while (high - low > 1) {
        const std::uint64_t middle = (low + high) / 2;
        if (middle * middle <= value)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/// Seeds for 1/sqrt(m), m in [1, 4): entry k is 1/sqrt(m) at the middle of [k/64, (k+1)/64), 31 fraction bits,
/// of which a hardware table would keep the upper 9. Entries below 64 are never read.
constexpr std::array<std::uint32_t, 256> make_reciprocal_root_seeds() {
    std::array<std::uint32_t, 256> seeds{};
    for (std::uint64_t k = 64; k < 256; ++k) {
        // 1/sqrt((2k+1)/128) = sqrt(128/(2k+1)), with 2 * 9 fraction bits under the root
        const std::uint64_t root = integer_square_root((std::uint64_t{128} << 40) / (2 * k + 1));  // 20 fraction bits
        seeds[k] = static_cast<std::uint32_t>(((root + (1 << 10)) >> 11) << 22);
    }
    return seeds;
}
inline constexpr auto reciprocal_root_seeds = make_reciprocal_root_seeds();

/// Widths in one Newton step; the same in all formats.
struct ReciprocalRootWidths : Intermediates {
    using Intermediates::Intermediates;
    Width mantissa{"m", 32};
    Width root{"y", 32};
    Width square{"y * y", 63};
    Width product{"m * y^2", 61};
    Width step{"y * (3 - m * y^2)", 63};
    constexpr auto all() const { return std::array{mantissa, root, square, product, step}; }
};
static_assert(fits_every_format<ReciprocalRootWidths>());

/// 1/sqrt(m / 2^30) with 31 fraction bits, for m in [2^30, 2^32).
/// Table look-up (relative error under 2^-7.7), then two Newton steps y = y (3 - m y^2) / 2.
/// Relative error under 2^-28.6 either way (exhaustive over m once; the tests sample densely).
constexpr std::uint64_t reciprocal_root(std::uint32_t m) {
    std::uint64_t y = reciprocal_root_seeds[m >> 24];
    for (int step = 0; step < 2; ++step) {
        const std::uint64_t square = (y * y) >> 32;        // 30 fraction bits
        const std::uint64_t product = (m * square) >> 30;  // 30 fraction bits, near 1
        y = (y * ((std::uint64_t{3} << 30) - product)) >> 31;
    }
    return y;
}

/// Widest component that normalise() accepts.
inline constexpr int largest_component_bits = 31;

struct NormaliseWidths : Intermediates {
    int component;
    constexpr explicit NormaliseWidths(const Formats& formats, int component_bits = largest_component_bits)
        : Intermediates(formats), component(component_bits) {}
    Width square{"x^2 + y^2 + z^2", 2 * component};
    Width root{"1 / length", ReciprocalRootWidths{f}.root.bits};
    Width product{"x / length, before rounding", component + root.bits};
    constexpr auto all() const { return std::array{square, root, product}; }
};
static_assert(fits_every_format<NormaliseWidths>());

/// Normalises a vector with components of up to 31 bits, of any scale, to unit length in the normal's format.
/// Rounded to nearest; error per component at most 1/2 + 2^(fraction - 28) LSB. A zero vector stays zero, on both sides
/// of an edge alike, and is counted.
constexpr Direction normalise(std::int64_t x, std::int64_t y, std::int64_t z, const Formats& formats,
                              Saturations& saturations) {
    const std::uint64_t square =
        static_cast<std::uint64_t>(x * x) + static_cast<std::uint64_t>(y * y) + static_cast<std::uint64_t>(z * z);
    if (square == 0) {
        ++saturations.degenerate_normal;
        return {};
    }
    const int shift = leading_zeros(square) & ~1;  // even, so that the root of the scale is a shift
    const std::uint64_t root = reciprocal_root(static_cast<std::uint32_t>((square << shift) >> 32));
    const int down = 62 - formats.normal.fraction - shift / 2;
    const auto scaled = [&](std::int64_t component) {
        return static_cast<std::int32_t>(saturate(round_shift(component * static_cast<std::int64_t>(root), down),
                                                  formats.normal, saturations.normal));
    };
    return {scaled(x), scaled(y), scaled(z)};
}
constexpr Direction normalise(const Direction& v, const Formats& formats, Saturations& saturations) {
    return normalise(v.x, v.y, v.z, formats, saturations);
}

inline Multiplications normalise_multiplications(const Formats& f, int component_bits) {
    const ReciprocalRootWidths w{f};
    const int square = w.square.bits - 32, correction = 32;
    return Multiplications()
        .add(3, component_bits, component_bits)
        .add(2, w.root.bits, w.root.bits)
        .add(2, w.mantissa.bits, square)
        .add(2, w.root.bits, correction)
        .add(3, w.root.bits, component_bits);
}

}  // namespace tessera::datapath
