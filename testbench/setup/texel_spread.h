#pragma once
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

/// Compares N' under the scene's one texel size with N' under each triangle's own dp/du and dp/dv, at no more than about
/// 2^16 points spread over the triangles. Needs the scene's map, formats, scale, height_per_code and texel_size.
TexelSpread measure_texel_spread(const BaseMesh& mesh, const PreparedScene& scene);

/// One sentence on a spread that matters, with figures and remedy; empty if 99 % of the surface, and of the map on it, have N'
/// right to `TexelSpread::noticeable`.
std::string texel_spread_remark(const TexelSpread& spread);

/// The same of displacements that are not small against the base mesh's radius of curvature.
std::string curved_base_remark(const TexelSpread& spread);

}  // namespace tessera
