#pragma once
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/model_scale.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

/// In: a mesh in model units, its texture coordinates in maps. Out: positions in world units, normals and tangents of
/// unit length, texture coordinates in texels (moved by whole periods towards 0 where the map repeats), each in its
/// format. Triangles in the mesh's order, of generation 0; base: their number. Also sets the scene's counts of what was
/// dropped, clamped and saturated, and remarks on them; needs its formats and map. Throws InputError if a texture
/// coordinate does not fit its format, or no triangle is left.
void round_base_triangles(const BaseMesh& mesh, const ModelScale& model_scale, PreparedScene& scene);

}  // namespace tessera
