#pragma once
#include "testbench/setup/height_map.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

/// The displacement of a map value along the normal, in model units: bias + scale * value.
struct MapDisplacement {
    double scale = 1, bias = 0;

    double of(double value) const { return bias + scale * value; }

    /// displacement.bias at span_low, bias + displacement.scale at span_high. If the two are equal, the map is flat.
    static MapDisplacement from(const DisplacementSettings& settings, const HeightMap& map) {
        const double span = map.span_high - map.span_low;
        const double scale = span > 0 ? settings.scale / span : 0;
        return {scale, settings.bias - scale * map.span_low};
    }
};

}  // namespace tessera
