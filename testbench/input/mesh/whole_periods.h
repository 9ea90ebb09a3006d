#pragma once
#include <glm/glm.hpp>

#include "testbench/input/mesh/base_mesh.h"

namespace tessera {

/// Brings texture coordinates to the lowest period of the axes that repeat. Each chart (triangles that share vertices,
/// or vertices of equal position and texture) goes down, or up, by one number of whole periods, so that its lowest
/// coordinate lies in 0..1. A chart that then reaches beyond `most` periods is split into its triangles, each shifted
/// by itself; they get vertices of their own where they differ.
///
/// A map that repeats reads the same at t and t + 1, and the datapath decides from differences and texels alone
/// (rectangle.h, midpoint.h), so that neighbours shifted differently decide alike.
BaseMesh bring_down_texture(BaseMesh mesh, const glm::bvec2& repeats, const glm::dvec2& most);

}  // namespace tessera
