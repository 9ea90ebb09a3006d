#pragma once
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/model_scale.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

/// Input: a mesh in model units, its texture coordinates in maps. Output: positions in world units, normals and
/// tangents of unit length, texture coordinates in texels (moved by whole periods towards 0 if the map repeats), each
/// in its format. Triangles are in the mesh's order, of generation 0; base: their index. Also sets the scene's counts
/// of dropped, clamped and saturated values, with remarks; needs its formats and map. Throws InputError if a texture
/// coordinate does not fit its format, or no triangle is left.
void round_base_triangles(const BaseMesh& mesh, const ModelScale& model_scale, PreparedScene& scene);

}  // namespace tessera
