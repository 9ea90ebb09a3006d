#pragma once
#include <cstdint>

#include "modules/timing/design_options.h"

namespace tessera::schedule {

/// A unit's number in the machine.
using Unit = std::uint8_t;
constexpr Unit nobody = 255;

/// The units of the first Tessellation Tests unit come last. of_tests() numbers those of the others.
enum : Unit {
    get_triangle,
    calculate_new_p,
    displace_vertex,
    transform,
    pass_or_tessellate,
    tessellation,
    triangle_queue,
    lighting,
    displacement_map,
    displacement_map_for_tests,
    normal_map,
    height_table,
    rasteriser,
    calculate_new_u,
    tex_coord_test,
    height_test,
    normal_test,
    view_test,
    collect_tests,
    units_with_one
};
constexpr Unit units_of_tests = units_with_one - calculate_new_u;

/// The number of the corresponding unit in Tessellation Tests unit k.
constexpr Unit of_tests(unsigned k, Unit unit) {
    return static_cast<Unit>(unit + k * units_of_tests);
}

}  // namespace tessera::schedule
