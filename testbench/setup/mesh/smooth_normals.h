#pragma once
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Replaces every zero normal by a smooth one: the mean normal of the triangles at its position, weighted by
/// their angle there (Thuermer and Wuethrich 1998), so that it does not depend on how a polygon was triangulated.
/// Vertices at one position share it, across texture seams and smoothing groups, since a displaced surface opens where
/// two normals meet at one point. If the triangles cancel, the first one's normal is used, and a repair counts it.
/// Needs positions and triangles of non-zero area.
void complete_smooth_normals(BaseMesh& mesh);

}  // namespace tessera
