#pragma once
#include "testbench/job/job.h"
#include "testbench/setup/height_map.h"

namespace tessera {

/// Sets the range that displacement.scale spans. Unless it is `full`, the codes span the values that occur.
inline void span_values(HeightMap& map, const MapRange& range) {
    if (range.kind == MapRange::Kind::full)
        return;
    const auto [low, high] = map.extremes();
    map.range_low = map.span_low = low;
    map.range_high = map.span_high = high;
    if (range.kind == MapRange::Kind::given) {
        map.span_low = range.low / map.source_units;
        map.span_high = range.high / map.source_units;
    }
}

}  // namespace tessera
