#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Anomalies of the surface that are reported but not repaired; one sentence each, with counts. Each lets the displaced
/// surface open or overlap, whatever the tessellator does:
/// - an edge of more than two triangles; neighbours of opposite winding
/// - T-junctions: a border vertex in the interior of another border edge (within 1e-6 of its length); the search
///   stops after `most_steps`, and reports that
/// - several normals at one position: a hard edge
/// - normals that point against the triangle's winding
/// Vertices are identified by their positions. Needs positions and unit normals.
/// `normals_remedy`: a sentence added to that on several normals.
std::vector<std::string> surface_flaws(const BaseMesh& mesh, std::uint64_t most_steps = largest_search,
                                       std::string_view normals_remedy = {});

}  // namespace tessera
