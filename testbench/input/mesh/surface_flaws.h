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

/// Points and edges of a mesh; vertices at one position are one point.
struct Surface {
    std::vector<std::uint32_t> points;                 ///< of each vertex: the first one at its position
    std::vector<std::array<std::uint32_t, 2>> border;  ///< edges of one triangle: their points
    std::size_t crowded = 0;                           ///< edges of more than two triangles
    std::size_t opposed = 0;                           ///< edges of two triangles of opposite winding
};
Surface surface_of(const BaseMesh& mesh);

/// Anomalies of the surface that are reported but not repaired; one sentence each, with counts. Each lets the displaced
/// surface open or overlap, whatever the tessellator does:
/// - an edge of more than two triangles; neighbours of opposite winding
/// - T-junctions: a border vertex in the interior of another border edge (within 1e-4 of its length); the search
///   stops after `most_steps`, and reports that
/// - several normals at one position: a hard edge
/// - normals that point against the triangle's winding
/// Needs unit normals. `normals_remedy`: a sentence added to that on several normals.
std::vector<std::string> surface_flaws(const BaseMesh& mesh, const Surface& surface,
                                       std::string_view normals_remedy = {}, std::uint64_t most_steps = largest_search);

/// Adds a sentence on vertices whose normal is no mean of the normals of the triangles at their position: it is 5 degrees or
/// more outside the cone about these. Not for an earlier run's mesh, whose normals are those of a finer surface.
void count_leaning_normals(BaseMesh& mesh, const Surface& surface);

}  // namespace tessera
