#pragma once
#include <string>

#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/prepared_scene.h"

namespace tessera {

/// Rounds mesh, map, camera and thresholds to the formats. No value of `settings` may be automatic. map_name: for
/// messages. Errors: InputError, with value, limit and remedy, if something cannot fit and no repair preserves its
/// meaning (a table entry too narrow for the largest rectangle, an eye too far away, a texture coordinate beyond the
/// format, a threshold beyond its register or below its step).
PreparedScene prepare_model(const SceneSettings& settings, const BaseMesh& mesh, const HeightMap& map,
                            const std::string& map_name);

}  // namespace tessera
