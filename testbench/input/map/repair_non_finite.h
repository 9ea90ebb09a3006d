#pragma once
#include "testbench/setup/height_map.h"

namespace tessera {

/// Makes every value of a floating-point map finite, and sets its range.
///
///     NaN, -infinity -> lowest finite value        (usually a hole in a scan or terrain)
///     +infinity      -> highest finite value
///
/// Each kind is counted and reported in `repairs`. range_low, range_high = lowest and highest finite value; equal
/// for a constant map. Returns false, and leaves the map unchanged, if no value is finite.
bool repair_non_finite(HeightMap& map);

}  // namespace tessera
