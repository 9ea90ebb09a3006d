#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/input/mesh/mesh_limits.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// The edges of a mesh; vertices at one position are one.
struct SurfaceEdges {
    std::vector<std::array<std::uint32_t, 2>> border;  ///< of one triangle: its first vertices at the two positions
    std::size_t crowded = 0;                           ///< of more than two triangles
    std::size_t opposed = 0;                           ///< of two triangles of opposite winding
};
SurfaceEdges edges_of_surface(const BaseMesh& mesh, const std::vector<std::uint32_t>& same_position);

/// Anomalies of the surface that are reported but not repaired; one sentence each, with counts. Each lets the displaced
/// surface open or overlap, whatever the tessellator does:
/// - an edge of more than two triangles; neighbours of opposite winding
/// - T-junctions: a border vertex in the interior of another border edge (within 1e-4 of its length); the search
///   stops after `most_steps`, and reports that
/// - several normals at one position: a hard edge
/// - normals that point against the triangle's winding
/// Vertices are identified by their positions. Needs positions and unit normals.
/// Sets mesh.winding_changes. `normals_remedy`: a sentence added to that on several normals.
std::vector<std::string> surface_flaws(BaseMesh& mesh, std::uint64_t most_steps = largest_search,
                                       std::string_view normals_remedy = {});

/// Adds a sentence on vertices whose normal is no mean of the normals of the triangles at their position: it is 5 degrees or
/// more outside the cone about these. Not for an earlier run's mesh, whose normals are those of a finer surface.
void count_leaning_normals(BaseMesh& mesh);

}  // namespace tessera
