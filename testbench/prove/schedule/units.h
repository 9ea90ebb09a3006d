#pragma once
#include <cstdint>

#include "modules/timing/timing.h"

namespace tessera::schedule {

/// A unit's number in the machine: those of all_units.h, then memories and the rasteriser.
using Unit = std::uint8_t;
constexpr Unit nobody = 255;

enum : Unit {
#define TESSERA_NUMBER(name, ...) name,
    TESSERA_FOR_EACH_UNIT(TESSERA_NUMBER, TESSERA_NUMBER)
#undef TESSERA_NUMBER
        displacement_map,
    displacement_map_for_tests,
    normal_map,
    height_table,
    rasteriser,
    units
};

}  // namespace tessera::schedule
