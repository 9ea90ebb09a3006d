#pragma once
#include <array>
#include <cstdint>

#include "modules/datapath/edge_tests.h"
#include "modules/datapath/intermediate.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// Children as indices: 0 to 2 are the triangle's vertices, 3 + k is the midpoint of edge k.
struct ChildIndices {
    std::array<std::array<std::uint8_t, 3>, 4> children{};
    int count = 0;
};

/// The second diagonal must be shorter than the first by more than 2^-6 of the first (the paper avoids long thin
/// triangles, in a figure only). Many pairs are equally long in exact arithmetic (172 of the default job's 2,470: a
/// square's where the map is level), and rounding must not decide between them. A fraction, since it moves each of a
/// length's six coordinates by up to (generation + 1) / 2 LSB of the position plus the height times 3/4 LSB of the
/// normal. In the default job that is below 2^-6 of a texel's side even at full height on a curved surface.
inline constexpr int diagonal_margin_shift = 6;

struct DiagonalWidths : Intermediates {
    using Intermediates::Intermediates;
    Width difference{"abs(dx), abs(dy), abs(dz)", f.position.bits};
    Width length{"abs(dx) + abs(dy) + abs(dz)", difference.bits + 2};
    Width compared{"the sum * 64", length.bits + diagonal_margin_shift};
    constexpr auto all() const { return std::array{difference, length, compared}; }
};
static_assert(fits_every_format<DiagonalWidths>());

/// Manhattan length between two displaced positions.
constexpr std::uint64_t manhattan_length(const Position& a, const Position& b) {
    return absolute_difference(a.x, b.x) + absolute_difference(a.y, b.y) + absolute_difference(a.z, b.z);
}

/// The quadrilateral that remains when two edges split, in the triangle's order: the boundary v0, m01, v1, m12, v2, m20
/// without the unsplit edge's midpoint and the corner opposite that edge.
constexpr std::array<std::uint8_t, 4> remaining_quadrilateral(int whole_edge) {
    constexpr std::array<std::array<std::uint8_t, 4>, 3> by_whole_edge = {{{0, 1, 4, 5}, {3, 1, 2, 5}, {0, 3, 4, 2}}};
    return by_whole_edge[static_cast<std::size_t>(whole_edge)];
}

/// The triangulations of the paper's figure 6. Bit k of `split` is set if edge k is split. With two split edges,
/// `second_diagonal` selects the quadrilateral's diagonal from its second vertex. Winding order is kept.
constexpr ChildIndices triangulate(unsigned split, bool second_diagonal) {
    switch (split) {
        case 0: return {{{{0, 1, 2}}}, 1};
        case 1: return {{{{0, 3, 2}, {3, 1, 2}}}, 2};
        case 2: return {{{{0, 1, 4}, {0, 4, 2}}}, 2};
        case 4: return {{{{0, 1, 5}, {5, 1, 2}}}, 2};
        case 7: return {{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}}, 4};
        default: break;
    }
    const int whole_edge = split == 6 ? 0 : (split == 5 ? 1 : 2);
    const auto q = remaining_quadrilateral(whole_edge);
    ChildIndices result;
    result.count = 3;
    result.children[0] = whole_edge == 0   ? std::array<std::uint8_t, 3>{5, 4, 2}
                         : whole_edge == 1 ? std::array<std::uint8_t, 3>{0, 3, 5}
                                           : std::array<std::uint8_t, 3>{3, 1, 4};
    if (second_diagonal) {
        result.children[1] = {q[0], q[1], q[3]};
        result.children[2] = {q[1], q[2], q[3]};
    } else {
        result.children[1] = {q[0], q[1], q[2]};
        result.children[2] = {q[0], q[2], q[3]};
    }
    return result;
}

/// With `shorter`, selects the second diagonal if its Manhattan length between displaced positions is shorter by more
/// than the margin. A subtraction and a compare, both exact. corner(k): the displaced position of index k as above.
template <class DisplacedPosition>
constexpr bool choose_second_diagonal(unsigned split, Triangulation choice, DisplacedPosition&& corner) {
    if (choice != Triangulation::shorter)
        return choice == Triangulation::second;
    if (split != 3 && split != 5 && split != 6)
        return false;
    const auto q = remaining_quadrilateral(split == 6 ? 0 : (split == 5 ? 1 : 2));
    const std::uint64_t first = manhattan_length(corner(q[0]), corner(q[2]));
    const std::uint64_t second = manhattan_length(corner(q[1]), corner(q[3]));
    return second << diagonal_margin_shift < (first << diagonal_margin_shift) - first;
}

}  // namespace tessera::datapath
