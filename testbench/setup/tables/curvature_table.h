#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/curvature.h"
#include "testbench/setup/quantised_map.h"
#include "testbench/setup/tables/grid_points.h"

namespace tessera {

/// The Curvature Test's table: a pyramid of cells (modules/datapath/curvature.h).
struct CurvatureTable {
    datapath::MapGeometry covered;       ///< texels: the map's, more if it clamps and the base mesh reaches beyond it
    std::vector<std::uint64_t> entries;  ///< packed, 36 bits each; level after level from 2, row by row
};

/// For each cell the quadratic of least squared error over a square of 2^l + 1 texels about it, addressed as the map
/// is, and the root of the mean squared error it leaves. If the square reaches beyond a clamped map, both times the
/// root of the share of the square that lies on the map: nobody sees the rest. base: texture coordinates of the base
/// triangles.
CurvatureTable make_curvature_table(const QuantisedMap& map, const std::vector<TextureTriangle>& base,
                                    const datapath::Formats& formats);

}  // namespace tessera
