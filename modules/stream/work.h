#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/triangle_pass.h"

namespace tessera {

/// The parts of a pass, one bit each, in the order in which Get Triangle sends them: the vertices of a base triangle,
/// normals that have no N's yet, edges.
using Parts = std::uint16_t;
constexpr unsigned first_normal_part = 3;
constexpr unsigned first_edge_part = 6;
constexpr Parts vertex_parts = 0007;
constexpr Parts normal_parts = 0070;
constexpr Parts edge_parts = 0700;

constexpr Parts parts_of(const datapath::TrianglePass& pass) {
    return static_cast<Parts>(pass.new_vertices | pass.new_normals << first_normal_part |
                              (pass.tested ? edge_parts : 0));
}

/// A triangle's pass through the machine, with what the model keeps beside the hardware's data.
struct Pass : datapath::TrianglePass {
    std::uint32_t number = 0;         ///< passes begun before this one: the triangle number of traces
    Parts geometry_left = 0;          ///< parts that Pass or Tessellate still waits for, from Transform
    Parts tests_left = 0;             ///< likewise from Tessellation Tests
    bool at_the_join = false;         ///< Pass or Tessellate has a place for it
    std::uint8_t corners_bumped = 0;  ///< vertices whose N' is known (Normal Test)
    std::array<std::uint8_t, 3> corners_on_screen{};  ///< vertices whose P's have come, per View Test
};

/// What travels on the streams of both branches: a pass and which of its parts. Functional mode sends all parts at
/// once, timed mode one after another; a unit does the same work on a part in both.
struct Work {
    Pass* pass = nullptr;
    Parts parts = 0;
};

/// Calls `each(index)` for the set bits among three, shifted down from `first`.
template <class Each>
inline void for_each_of_three(Parts parts, unsigned first, Each&& each) {
    for (unsigned k = 0; k < 3; ++k) {
        if ((unsigned{parts} >> (first + k) & 1u) != 0)
            each(k);
    }
}

}  // namespace tessera
