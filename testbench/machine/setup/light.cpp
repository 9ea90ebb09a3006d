#include "testbench/machine/setup/light.h"

#include <cmath>

#include "testbench/machine/setup/rounding.h"
#include "testbench/machine/setup/unit_vector.h"

namespace tessera {

glm::dvec3 towards_light(const Job::Hardware& hardware) {
    return unit_vector(glm::dvec3(hardware.light[0], hardware.light[1], hardware.light[2]));
}

datapath::LightParameters make_light(const Job::Hardware& hardware, const ViewAxes& view,
                                     const datapath::Format& normal, std::uint64_t& saturated) {
    const glm::dvec3 world = towards_light(hardware);
    const glm::dvec3 seen(glm::dot(view.right, world), glm::dot(view.up, world), glm::dot(view.backward, world));
    const datapath::Direction d = to_direction(seen, normal, saturated);
    datapath::LightParameters result;
    result.direction = {d.x, d.y, d.z};
    result.ambient = static_cast<std::int32_t>(std::lround(hardware.ambient * 256));
    return result;
}

}  // namespace tessera
