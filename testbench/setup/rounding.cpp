#include "testbench/setup/rounding.h"

#include <algorithm>
#include <cmath>

namespace tessera {

using datapath::Format;

std::int64_t to_fixed(double value, int fraction) {
    return static_cast<std::int64_t>(std::nearbyint(std::ldexp(value, fraction)));
}

std::int32_t to_format(double value, const Format& format, std::uint64_t& saturated) {
    const double scaled = std::nearbyint(std::ldexp(value, format.fraction));
    const auto lowest = static_cast<double>(format.lowest), highest = static_cast<double>(format.highest);
    saturated += scaled >= lowest && scaled <= highest ? 0 : 1;
    return static_cast<std::int32_t>(std::clamp(scaled, lowest, highest));
}

datapath::Direction to_direction(const glm::dvec3& v, const Format& format, std::uint64_t& saturated) {
    return {to_format(v.x, format, saturated), to_format(v.y, format, saturated), to_format(v.z, format, saturated)};
}

}  // namespace tessera
