#pragma once
#include <cstdint>

namespace tessera::schedule {

/// A unit's number in the machine.
using Unit = std::uint8_t;
constexpr Unit nobody = 255;

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
    units
};

}  // namespace tessera::schedule
