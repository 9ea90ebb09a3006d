#pragma once
#include <cstdint>

#include "modules/datapath/format.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Diffuse per-vertex lighting in screen space: ambient + (256 - ambient) * max(0, N's . L), 0..255, truncated.
/// The pipeline's existing unit, reduced to one directional light.
constexpr std::uint8_t light(const Direction& screen_normal, const LightParameters& parameters,
                             const Formats& formats) {
    const std::int64_t dot = std::int64_t{screen_normal.x} * parameters.direction[0] +
                             std::int64_t{screen_normal.y} * parameters.direction[1] +
                             std::int64_t{screen_normal.z} * parameters.direction[2];
    const std::int64_t cosine = dot > 0 ? dot >> formats.normal.fraction : 0;
    const std::int64_t intensity =
        parameters.ambient + (((256 - parameters.ambient) * cosine) >> formats.normal.fraction);
    return static_cast<std::uint8_t>(intensity > 255 ? 255 : intensity);
}

}  // namespace tessera::datapath
