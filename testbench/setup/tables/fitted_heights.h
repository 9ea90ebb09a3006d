#pragma once
#include <vector>

#include "testbench/setup/quantised_map.h"
#include "testbench/setup/tables/grid_points.h"

namespace tessera {

/// The map with other codes under the vertices of a mesh: those that minimise the mesh's squared vertical error over
/// all grid points of the map, rounded to codes. Valid for one fixed mesh. Tables of the Rank, Bound and Curvature
/// Tests made from the original map do not change; the Curvature Test's level 1, which reads codes, does.
///
/// mesh: texture coordinates of the finished triangles. Vertices in the same texel share its code.
QuantisedMap fit_heights(const QuantisedMap& map, const std::vector<TextureTriangle>& mesh,
                         const datapath::Formats& formats);

}  // namespace tessera
