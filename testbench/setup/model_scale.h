#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "modules/datapath/parameters.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/scene_settings.h"

namespace tessera {

/// Converts model units to the machine's world and back: world = scale * (model - centre). scale is a power of two, so
/// that dividing by it is exact.
struct ModelScale {
    double scale = 1;
    glm::dvec3 centre{0};

    glm::dvec3 to_world(const glm::dvec3& model) const { return (model - centre) * scale; }
    glm::dvec3 to_model(const glm::dvec3& world) const { return world / scale + centre; }
};

/// The displacement in model units at the machine's d = 0, and its full range.
struct DisplacementRange {
    double bias;   ///< at code 0
    double range;  ///< from code 0 to the highest code
};

DisplacementRange displacement_range(const DisplacementSettings& settings, const HeightMap& map);

/// Chooses centre and scale so that the displaced model fits half of the position's range: nothing saturates, and the
/// eye of a usual camera has room. Throws InputError, which names the values that displace it and begins with the map's
/// name, if the displacement is so large that the mesh spans too few steps of the format.
ModelScale fit_model(const BaseMesh& mesh, const DisplacementSettings& settings, const HeightMap& map,
                     const datapath::Format& position, const std::string& map_name);

/// The registers S and bias of P' = P + (S * d + bias) * N, in the position's format. highest_code: of the map.
datapath::DisplacementParameters make_displacement(const DisplacementRange& displacement, const ModelScale& model_scale,
                                                   std::uint32_t highest_code, const datapath::Format& position,
                                                   std::uint64_t& saturated);

}  // namespace tessera
