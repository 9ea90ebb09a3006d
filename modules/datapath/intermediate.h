#pragma once
#include "modules/datapath/format.h"

namespace tessera::datapath {

/// An intermediate value of a function: the bits it needs, including a sign, and the bits of the model's integer (64:
/// std::int64_t if it may be negative, else std::uint64_t).
struct Width {
    const char* name = "";
    int bits = 0;
    int most = 64;
};

/// Base of the structs that give the widths of a function's intermediates for the formats f. all() lists them.
struct Intermediates {
    Formats f;
    constexpr explicit Intermediates(const Formats& formats) : f(formats) {}
};

constexpr int wider(int a, int b) {
    return a > b ? a : b;
}

/// Bits of a value from -2^exponent to 2^exponent inclusive.
constexpr int signed_bits(int exponent) {
    return exponent + 2;
}

/// The first intermediate that does not fit the model's integer; null if all fit.
template <class Widths>
constexpr const char* first_too_wide(const Widths& widths) {
    for (const Width& width : widths.all())
        if (width.bits > width.most)
            return width.name;
    return nullptr;
}

/// Whether the model's integers hold every intermediate in all formats within FormatLimits. It suffices to check the
/// greatest widths with the fewest and the most fraction bits: intermediates grow with their operands' widths, and
/// shifts depend on the fraction bits. A bilinear filter adds bits.
template <class Widths>
constexpr bool fits_every_format() {
    using Limits = FormatLimits;
    for (unsigned corner = 0; corner < 32; ++corner) {
        const auto fraction = [&](int place, const FormatLimits::Range& range) {
            return (corner >> place & 1u) != 0 ? range.most : range.least;
        };
        Formats f;
        const int position_fraction = fraction(0, Limits::position_fraction);
        const int texture_fraction = fraction(2, Limits::texture_fraction);
        f.position = Format::make_signed(Limits::position_bits.most, position_fraction);
        f.view_distance = Format::make_signed(Limits::position_bits.most,
                                              position_fraction - fraction(4, Limits::view_distance_shift));
        f.normal = Format::make_signed(Limits::normal_bits.most, fraction(1, Limits::normal_fraction));
        f.texture = Format::make_unsigned(Limits::texture_integer.most + texture_fraction + 1, texture_fraction);
        f.displacement = Format::make_unsigned(Limits::displacement_bits.most, Limits::displacement_bits.most);
        f.summed_height = Format::make_unsigned(Limits::summed_height_bits.most, 0);
        f.screen = Format::make_signed(Limits::screen_bits.most, fraction(3, Limits::screen_fraction));
        f.generation_bits = Limits::generation_bits.most;
        f.filter = MapFilter::bilinear;
        f.tex_coord_fraction = Limits::tex_coord_fraction.most;
        if (first_too_wide(Widths{f}) != nullptr)
            return false;
    }
    return true;
}

}  // namespace tessera::datapath
