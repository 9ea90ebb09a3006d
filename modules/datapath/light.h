#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/format.h"
#include "modules/datapath/intermediate.h"
#include "modules/datapath/multiplications.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

struct LightWidths : Intermediates {
    using Intermediates::Intermediates;
    Width product{"N's.x * L.x", 2 * f.normal.bits};
    Width dot{"N's . L", product.bits + 1};
    Width cosine{"N's . L, at least 0, truncated", dot.bits - f.normal.fraction - 1, 63};
    Width scaled{"(256 - ambient) * that", cosine.bits + 8, 63};
    Width intensity{"ambient + that, before saturation", wider(scaled.bits - f.normal.fraction, 9) + 1, 63};
    constexpr auto all() const { return std::array{product, dot, cosine, scaled, intensity}; }
};
static_assert(fits_every_format<LightWidths>());

/// Diffuse per-vertex lighting in screen space: ambient + (256 - ambient) * max(0, N's . L), 0..255, truncated. Full
/// light, 256, saturates, counted.
/// The pipeline's existing unit, reduced to one directional light.
constexpr std::uint8_t light(const Direction& screen_normal, const LightParameters& parameters, const Formats& formats,
                             Saturations& saturations) {
    const std::int64_t dot = std::int64_t{screen_normal.x} * parameters.direction[0] +
                             std::int64_t{screen_normal.y} * parameters.direction[1] +
                             std::int64_t{screen_normal.z} * parameters.direction[2];
    const std::int64_t cosine = dot > 0 ? dot >> formats.normal.fraction : 0;
    const std::int64_t intensity =
        parameters.ambient + (((256 - parameters.ambient) * cosine) >> formats.normal.fraction);
    constexpr Format eight_bits = Format::make_unsigned(8, 8);
    return static_cast<std::uint8_t>(saturate(intensity, eight_bits, saturations.intensity));
}

inline Multiplications light_multiplications(const Formats& f) {
    constexpr int ambient = 9;
    return Multiplications().add(3, f.normal.bits, f.normal.bits).add(1, LightWidths{f}.cosine.bits, ambient);
}

}  // namespace tessera::datapath
