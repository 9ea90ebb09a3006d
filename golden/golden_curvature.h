#pragma once
#include <cstdint>

#include "golden/golden_map.h"

namespace tessera::golden {

/// A cell of the Curvature Table (ALGORITHM.md 4.8 and section 6), before rounding; `unit` is 0. reach: half the side of
/// its square, in texels. column, row: of its centre's texel, which may lie beyond a clamped map.
Curvature fit_curvature(const Map& map, std::int64_t column, std::int64_t row, std::int64_t reach);

}  // namespace tessera::golden
