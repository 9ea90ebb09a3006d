#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "modules/datapath/parameters.h"
#include "testbench/setup/scene_settings.h"
#include "testbench/setup/view.h"

namespace tessera {

/// Unit direction towards the light, world space.
glm::dvec3 towards_light(const SceneOptions& options);

/// Lighting's registers: the direction in view space, in the normal's format; ambient light in units of 1/256.
datapath::LightParameters make_light(const SceneOptions& options, const ViewAxes& view, const datapath::Format& normal,
                                     std::uint64_t& saturated);

}  // namespace tessera
