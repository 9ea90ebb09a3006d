#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "testbench/machine/emitted_mesh.h"
#include "testbench/output/report/mesh_units.h"
#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// The triangles of an emitted mesh that were not culled, with shared vertices, as in a file. Indices only; the mesh
/// itself is not copied.
struct IndexedMesh {
    struct Triangle {
        std::uint32_t triangle;  ///< its index in the emitted mesh
        std::array<std::uint32_t, 3> vertices;
    };
    /// Indices of corners (EmittedTriangles::corners), in the order of their first use. Two corners are one vertex if
    /// they agree in P, P', N' and t.
    std::vector<std::uint32_t> vertices;
    std::vector<Triangle> triangles;

    /// ResourceError beyond 700 million triangles.
    static IndexedMesh from(const EmittedMesh& mesh);
};

/// The generation of a triangle: the highest of its vertices.
std::uint8_t triangle_generation(const EmittedTriangle& triangle);

/// The mesh as in a run's mesh.ply. ResourceError as above.
RecordedMesh recorded_mesh(const EmittedMesh& mesh, const MeshUnits& units);

}  // namespace tessera
