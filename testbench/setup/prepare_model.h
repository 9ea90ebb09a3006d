#pragma once
#include <string>

#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

/// Rounds mesh, map, camera and thresholds to the formats. No value of `settings` may be automatic. map_name: in
/// messages. Errors: InputError where something cannot fit and no repair keeps the meaning (a table entry too narrow
/// for the largest rectangle, an eye too far away, a texture coordinate beyond the format, a threshold beyond its
/// register or below its step), with value, limit and what to do.
PreparedScene prepare_model(const SceneSettings& settings, const BaseMesh& mesh, const HeightMap& map,
                            const std::string& map_name);

}  // namespace tessera
