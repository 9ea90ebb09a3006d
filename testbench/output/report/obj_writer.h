#pragma once
#include <filesystem>

#include "testbench/machine/emitted_mesh.h"
#include "testbench/output/report/mesh_units.h"

namespace tessera {

/// Writes the triangles that were not culled as a Wavefront OBJ file: `v` P' in model units (doubles,
/// shortest digits that read back exactly), `vt` texture coordinates and `vn` N' (likewise, of floats), `f
/// a/a/a b/b/b c/c/c`.
///
/// Generation and deciding test of a triangle are its group and material, `g normal_g3` and `usemtl
/// normal_g3`: the test that split its parent (base: none did, it is a base triangle; normal; summed_height or its
/// replacement; both; highlight: the Highlight Test alone), and the generation of its youngest vertex. Each group comes
/// once, by test and generation; within it, triangles are in the mesh's order (call EmittedMesh::sort()
/// before). No material file is named: readers create plain materials of these names. Vertices by first use
/// in the mesh, shared as in indexed_mesh.h. The same mesh gives the same bytes on every compiler and machine.
/// Errors: as in atomic_file.h.
void write_obj(const std::filesystem::path& path, const EmittedMesh& mesh, const MeshUnits& units);

}  // namespace tessera
