#pragma once
#include <filesystem>

#include "testbench/machine/emitted_mesh.h"
#include "testbench/output/report/mesh_units.h"

namespace tessera {

/// Writes the triangles that were not culled as a binary little-endian PLY file, 52 bytes per vertex, 20 per triangle.
///
///     vertex: double x y z         P' in model units
///             float nx ny nz       N'
///             double s t           texture coordinates, 0..1 spans the map (s, t: the names readers know)
///     face:   list uchar int vertex_indices
///             uchar generation     of its youngest vertex
///             uchar split_by       which tests split its parent: 1 Normal, 2 height test, 3 both; 32 is added
///                                  where the Highlight Test was true; 0: a base triangle
///             uchar stopped_by     sum of 4 View, 8 Tex Coord, 16 Generation: what kept an edge of it whole
///             int base             its base triangle
///
/// Positions and texture coordinates are doubles: the machine's 32 bits do not fit a float, and a float's rounding
/// would separate the two sides of a texture seam in a run that uses this mesh as its base. The header's comments
/// repeat all this. Order: the mesh's (call EmittedMesh::sort() before); vertices by first use, shared as in
/// indexed_mesh.h. The same mesh gives the same bytes on every compiler and machine. Errors: as in atomic_file.h.
void write_ply(const std::filesystem::path& path, const EmittedMesh& mesh, const MeshUnits& units);

}  // namespace tessera
