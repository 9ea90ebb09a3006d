#pragma once
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Gives every vertex its tangent and handedness (golden/ALGORITHM.md section 6).
///
/// Triangles on both sides of an edge share frames at its ends if position, normal and texture coordinates agree there,
/// the latter up to the same whole periods at both ends: only such an edge stays closed in the displaced surface.
/// Others open anyway, and one frame for parts of the map that are turned or mirrored against each other is wrong for
/// both. Each triangle adds its direction of dp/du, weighted by its area; the sum is orthogonalised against the normal
/// and normalised. A vertex whose triangles have several frames is copied, one copy a frame.
///
/// The tangent is zero where nothing defines it: no dp/du, directions that cancel (a pole), or triangles mirrored in
/// texture space and others in one frame. Midpoints towards other vertices then have their tangent, which is right on
/// both sides; a triangle with three such corners has none. Each of these is counted in a sentence of mesh.repairs.
///
/// (Decision: with two frames at a mirrored edge each side would be right, but the Normal Test compares world
/// components, which do not mirror, and the sides decide differently: 8 open pieces along three such edges of a plane
/// turned in space. A mirrored part of less than 6 % of the area around a vertex is taken for a slip of the unwrapping,
/// of which scans have some, and follows the others, so that its normals are kept.)
///
/// Needs positions, unit normals, texture coordinates and triangles of non-zero area.
void complete_tangent_frames(BaseMesh& mesh);

}  // namespace tessera
