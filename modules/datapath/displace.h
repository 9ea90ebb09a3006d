#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/bilinear.h"
#include "modules/datapath/format.h"
#include "modules/datapath/intermediate.h"
#include "modules/datapath/multiplications.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

struct DisplaceWidths : Intermediates {
    using Intermediates::Intermediates;
    Width product{"S * code", f.position.bits + f.displacement.bits + code_fraction(f)};
    Width height{"S * d + bias", f.position.bits + 1};
    Width along{"(S * d + bias) * N", height.bits + f.normal.bits};
    Width step{"the same, rounded", along.bits - f.normal.fraction};
    Width sum{"P + that, before saturation", wider(step.bits, f.position.bits) + 1};
    constexpr auto all() const { return std::array{product, height, along, step, sum}; }
};
static_assert(fits_every_format<DisplaceWidths>());

/// P' = P + (S * d + bias) * N (paper equation 1 with the scale of 5.1), d = code / 2^bits: a shift instead of a
/// division. The highest code displaces by the full scale all the same, as the host scales S by
/// 2^bits / (2^bits - 1). The code has code_fraction fraction bits (bilinear.h): none if it is a texel's.
/// Rounding: S * d to nearest in the position's format, the product with N to nearest. Error at most
/// 1/2 * (|N| + 1) LSB. Saturates, counted.
constexpr Position displace(const Position& p, const Direction& n, std::uint32_t code,
                            const DisplacementParameters& parameters, const Formats& formats,
                            Saturations& saturations) {
    const std::int64_t product = std::int64_t{parameters.scale} * code;
    const std::int64_t height =
        round_shift(product, formats.displacement.bits + code_fraction(formats)) + parameters.bias;
    const auto along = [&](std::int64_t base, std::int64_t normal) {
        return static_cast<std::int32_t>(saturate(base + round_shift(height * normal, formats.normal.fraction),
                                                  formats.position, saturations.displaced_position));
    };
    return {along(p.x, n.x), along(p.y, n.y), along(p.z, n.z)};
}

inline Multiplications displace_multiplications(const Formats& f) {
    const DisplaceWidths w{f};
    return Multiplications()
        .add(1, f.position.bits, f.displacement.bits + code_fraction(f))
        .add(3, w.height.bits, f.normal.bits);
}

}  // namespace tessera::datapath
