#pragma once
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Sets mesh.texture_scale (golden/ALGORITHM.md section 6): the area-weighted mean of |dp/du| and |dp/dv| over the
/// triangles that have texture area, but for slivers in the map, with the smallest and the largest. If there are none it
/// stays 1, with a repair. Needs positions, texture coordinates and triangles.
void measure_texture_scale(BaseMesh& mesh);

}  // namespace tessera
