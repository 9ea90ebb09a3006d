#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "testbench/setup/height_map.h"

namespace tessera {

/// Replaces the values that are no heights:
///
///     NaN, -infinity, map.no_data -> lowest of the other values    (usually a hole in a scan or terrain)
///     +infinity                   -> highest of the other values
///
/// Each kind is counted and reported in `repairs`, as is a value of no_data that no texel has; `replaced` lists the
/// texels. no_data: in source units; a value matches if it is the nearest to it of the map's precision, or, beyond 1e30,
/// if it differs by at most 1 %. Returns the lowest and the highest remaining value; nothing, and leaves the map
/// unchanged, if no texel has a height.
std::optional<std::array<float, 2>> replace_missing(HeightMap& map, const std::vector<double>& no_data);

/// Sets `no_data_hint` if the values look as if some of them mark missing data: the lowest or highest value, or up to
/// four nearly equal ones, is held by several texels and farther from the next value than all others from each other, or
/// by one, a thousand times as far; a narrower gap is enough beside many values or densely lying ones. Beside fewer than 8
/// others (masks, steps) the gap must be wide, and the value neither 0 nor an end of the ranges 0..1 and 8 bits.
/// Also if a value among the heights, or little apart from them, is held by texels that stand out from those beside them:
/// a usual marker, the lowest or highest value, the only negative one, 0, and in floating-point maps any single one.
/// Also if near several texels of the lowest or highest value, and nowhere else, lie values between it and the heights:
/// a border that resampling has blurred. given: map.no_data.
void suspect_no_data(HeightMap& map, const std::vector<double>& given);

}  // namespace tessera
