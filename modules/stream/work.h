#pragma once
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
constexpr Parts all_parts = 0777;

constexpr Parts parts_of(const datapath::TrianglePass& pass) {
    return static_cast<Parts>(pass.new_vertices | pass.new_normals << first_normal_part |
                              (pass.tested ? edge_parts : 0));
}

/// The parts that go to Tessellation Tests unit `number` of 1 or 3: all vertices and edges; of three units, one edge
/// and the two vertices it joins.
constexpr Parts parts_for_tests(unsigned number, unsigned units) {
    if (units == 1)
        return vertex_parts | edge_parts;
    return static_cast<Parts>(1u << (first_edge_part + number) | 1u << number | 1u << (number + 1) % 3);
}
/// Of some parts that come in order, the last.
constexpr Parts last_of(Parts parts) {
    while ((parts & (parts - 1)) != 0)
        parts = static_cast<Parts>(parts & (parts - 1));
    return parts;
}

/// Names a triangle's pass while it is under way: the number of passes begun before it, modulo 2^32. Hardware needs as
/// many bits as tell those apart that are under way at a time.
using Tag = std::uint32_t;

/// A triangle's pass through the machine.
struct Pass : datapath::TrianglePass {
    Tag number = 0;
};

/// What travels on the streams of both branches: a pass and which of its parts. Functional mode sends all parts at
/// once, timed mode one after another; a unit works on one part at a time in both.
struct Work {
    Pass* pass = nullptr;
    Parts parts = 0;

    Tag tag() const { return pass->number; }
    /// Of a single part: which vertex, normal or edge, 0 to 2.
    unsigned index() const { return parts == 0 ? 0 : static_cast<unsigned>(__builtin_ctz(parts)) % 3; }
    bool is_vertex() const { return (parts & vertex_parts) != 0; }
    bool is_normal() const { return (parts & normal_parts) != 0; }
    bool is_edge() const { return (parts & edge_parts) != 0; }
};

}  // namespace tessera
