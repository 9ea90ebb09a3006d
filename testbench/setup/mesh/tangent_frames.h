#pragma once
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Gives every vertex its tangent and handedness (golden/ALGORITHM.md section 6).
///
/// Each triangle adds its direction of dp/du, weighted by its area, to its vertices; the sum is orthogonalised
/// against the normal and normalised. Vertices of equal position and normal (bit for bit, -0 = +0) share one
/// frame, so a texture seam stays closed. Handedness is that of the majority of triangles, or +1 for a tie.
///
/// Repairs, each counted in one sentence of mesh.repairs: no dp/du at a vertex, or directions that cancel (a pole),
/// where a fixed perpendicular of the normal is used; texture mirrored across a vertex.
/// Needs positions, unit normals, texture coordinates and triangles of non-zero area.
void complete_tangent_frames(BaseMesh& mesh);

}  // namespace tessera
