#pragma once
#include <glm/glm.hpp>

#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Moves texture coordinates to the lowest period of repeated axes. Each chart (triangles that share vertices, or
/// vertices of equal position and texture) is shifted by whole periods, so that its lowest coordinate lies in 0..1. A
/// chart that then extends beyond `most` periods is split into its triangles, which are shifted one by one and get
/// separate vertices where their shifts differ: the format is unsigned, and tiling coordinates may be large.
///
/// A repeated map reads the same at t and t + 1, and the datapath's decisions depend on differences and texels alone
/// (rectangle.h, midpoint.h), so that neighbours with different shifts make the same decisions.
BaseMesh bring_down_texture(BaseMesh mesh, const glm::bvec2& repeats, const glm::dvec2& most);

}  // namespace tessera
