#pragma once
#include "testbench/render/render_mesh.h"

namespace tessera {

/// The least error that this fraction (0..1) of a mesh's area does not exceed; needs RenderMesh::triangle_errors. The
/// largest error if the mesh has no area; 0 if it is empty.
double error_of_most(const RenderMesh& mesh, double share);

double largest_of(const std::vector<float>& errors);

}  // namespace tessera
