#pragma once
#include "testbench/input/mesh/base_mesh.h"

namespace tessera {

/// Gives every vertex whose normal is the zero vector a smooth one: the mean of the triangles that touch its
/// position, weighted by their angle there (Thuermer and Wuethrich 1998), so that it does not depend on how a
/// polygon was triangulated. Vertices of one position are smoothed together, across texture seams and
/// smoothing groups: a displaced surface opens wherever two normals meet at one point. Where the triangles
/// cancel, the first one's normal is taken, and a repair counts it. Needs positions and triangles of non-zero
/// area.
void complete_smooth_normals(BaseMesh& mesh);

}  // namespace tessera
