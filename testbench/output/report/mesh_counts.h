#pragma once
#include <cstdint>

#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// The vertices and edges of a finished mesh, including culled triangles, each counted once. A vertex is identified by
/// t, P' and N', an edge by its two ends: on a texture seam or a crease each side has its own.
struct MeshCounts {
    std::uint64_t vertices = 0;
    std::uint64_t inserted_vertices = 0;  ///< of these, inserted: one for each distinct edge that was split
    std::uint64_t edges = 0;

    /// Distinct edges that the machine tested: those of the mesh and those that were split. Vertices merged by rounding
    /// count once.
    std::uint64_t tested_edges() const { return edges + inserted_vertices; }
};

/// Counts by 64-bit hashes; takes 24 bytes per triangle. With a million vertices two collide in one of 10^7 meshes.
MeshCounts count_mesh(const EmittedMesh& mesh);

}  // namespace tessera
