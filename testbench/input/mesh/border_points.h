#pragma once
#include "testbench/input/mesh/surface_flaws.h"

namespace tessera {

/// Gives a point of the border that lies within 1e-6 of the mesh's size of an earlier one its position: programs write
/// cos(2 pi) and cos(0) as different numbers, and a surface opens between points that differ. Those that lie within 1e-4
/// of another are counted. A point with an edge of less than 8 times that length is left alone, so that no triangle
/// collapses. Says both in mesh.repairs.
void join_border_points(BaseMesh& mesh, Surface& surface);

}  // namespace tessera
