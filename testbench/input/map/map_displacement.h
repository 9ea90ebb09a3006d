#pragma once
#include <algorithm>

#include "testbench/input/map/height_map.h"
#include "testbench/job/job.h"

namespace tessera {

/// Sets the range that displacement.scale spans. Unless it is `full`, the codes span the values that occur.
inline void span_values(HeightMap& map, const MapRange& range) {
    if (range.kind == MapRange::Kind::full)
        return;
    const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end());
    map.range_low = map.span_low = static_cast<double>(*low);
    map.range_high = map.span_high = static_cast<double>(*high);
    if (range.kind == MapRange::Kind::given) {
        map.span_low = range.low / map.source_units;
        map.span_high = range.high / map.source_units;
    }
}

/// The displacement of a map value along the normal, in model units: bias + scale * value.
struct MapDisplacement {
    double scale = 1, bias = 0;

    double of(double value) const { return bias + scale * value; }

    /// displacement.bias at span_low, bias + displacement.scale at span_high. If the two are equal, the map is flat.
    static MapDisplacement from(const Job::Displacement& job, const HeightMap& map) {
        const double span = map.span_high - map.span_low;
        const double scale = span > 0 ? job.scale / span : 0;
        return {scale, job.bias - scale * map.span_low};
    }
};

}  // namespace tessera
