#pragma once
#include <cstdint>
#include <string_view>

#include "testbench/setup/height_map.h"

namespace tessera {

/// Built-in maps: sides 1..largest_map_side (else InputError), values in 0..1, range 0..1, u to the right,
/// v upwards, both taken at texel centres. Bit-identical for every compiler and optimisation level: only integer
/// arithmetic and + - * / and sqrt are used, which IEEE 754 rounds correctly.

/// Half a torus on the plane [-1,1] x [-1,1] (stretched over a map that is not square), major radius
/// 0.55, minor radius r = 0.25: sqrt(max(0, r^2 - (rho - 0.55)^2)) / r. Scale r gives a circular cross-section.
HeightMap half_donut_map(std::int64_t width, std::int64_t height);

/// One line of raised letters with round edges, as large as possible, centred. Characters: stroke_font.h.
/// InputError: unknown character, only spaces, letters less than 7 texels high.
HeightMap text_map(std::int64_t width, std::int64_t height, std::string_view text);

/// White noise, every texel independent and uniform on the multiples of 1/65535: the hardest case for the
/// tests. A texel depends on seed, x and y, not on the map's size.
HeightMap noise_map(std::int64_t width, std::int64_t height, std::int64_t seed);

/// A constant map. InputError if the value is not in 0..1.
HeightMap constant_map(std::int64_t width, std::int64_t height, double value);

/// Rises along u, (x + 0.5) / width: second differences are zero up to rounding.
HeightMap ramp_map(std::int64_t width, std::int64_t height);

}  // namespace tessera
