#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/input/mesh/base_mesh.h"
#include "testbench/input/mesh/mesh_limits.h"

namespace tessera {

/// What is odd about the mesh as a surface and is left as it is; one sentence each, with counts. Each of
/// these lets the displaced surface open or overlap, whatever the tessellator does:
/// - an edge of more than two triangles; neighbours of opposite winding
/// - T-junctions: a vertex of the border on the inside of another border edge (within 1e-6 of its length);
/// the
///   search is given up beyond `most_steps`, and says so
/// - several normals at one position: a hard edge
/// - normals that point against the triangle's winding
/// Vertices are the same here when their positions are. Needs positions and unit normals.
std::vector<std::string> surface_flaws(BaseMesh const& mesh, std::uint64_t most_steps = largest_search);

}  // namespace tessera
