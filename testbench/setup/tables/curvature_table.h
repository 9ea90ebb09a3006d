#pragma once
#include <cstdint>
#include <vector>

#include "modules/datapath/curvature.h"
#include "testbench/setup/quantised_map.h"
#include "testbench/setup/tables/grid_points.h"

namespace tessera {

/// The Curvature Test's table: a pyramid of cells (modules/datapath/curvature.h).
struct CurvatureTable {
    datapath::MapGeometry covered;       ///< texels: the map's, or more if it clamps and the mesh extends beyond it
    std::vector<std::uint64_t> entries;  ///< packed, 36 bits each, 12 per texel; by level from 2, then row by row
};

/// For each cell, the least-squares quadratic over a square of 2^l + 1 texels around it, addressed as the map is, and
/// the root mean square of its residual. If the square extends beyond a clamped map, both are multiplied by the root of
/// the fraction of the square on the map, since the rest is never visible. base: texture coordinates of the base
/// triangles.
CurvatureTable make_curvature_table(const QuantisedMap& map, const std::vector<TextureTriangle>& base,
                                    const datapath::Formats& formats);

}  // namespace tessera
