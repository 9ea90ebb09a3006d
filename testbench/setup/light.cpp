#include "testbench/setup/light.h"

#include <cmath>

#include "testbench/setup/rounding.h"
#include "testbench/setup/unit_vector.h"

namespace tessera {

glm::dvec3 towards_light(const SceneOptions& options) {
    return unit_vector(glm::dvec3(options.light[0], options.light[1], options.light[2]));
}

datapath::LightParameters make_light(const SceneOptions& options, const ViewAxes& view, const datapath::Format& normal,
                                     std::uint64_t& saturated) {
    const glm::dvec3 world = towards_light(options);
    const glm::dvec3 seen(glm::dot(view.right, world), glm::dot(view.up, world), glm::dot(view.backward, world));
    const datapath::Direction d = to_direction(seen, normal, saturated);
    datapath::LightParameters result;
    result.direction = {d.x, d.y, d.z};
    result.ambient = static_cast<std::int32_t>(std::lround(options.ambient * 256));
    return result;
}

}  // namespace tessera
