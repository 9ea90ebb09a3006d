#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "modules/datapath/format.h"
#include "modules/datapath/vertex.h"

namespace tessera {

/// value * 2^fraction, to nearest, ties to even.
std::int64_t to_fixed(double value, int fraction);

/// The same for a format; values out of range become the nearest value in range and are counted in `saturated`.
std::int32_t to_format(double value, const datapath::Format& format, std::uint64_t& saturated);

/// The same by component, without normalising.
datapath::Direction to_direction(const glm::dvec3& v, const datapath::Format& format, std::uint64_t& saturated);

}  // namespace tessera
