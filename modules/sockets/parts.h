#pragma once
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "modules/datapath/family.h"
#include "modules/datapath/fields.h"
#include "modules/timing/work.h"

namespace tessera {

/// The parts of a triangle, one bit each, in the order in which Get Triangle sends them: the vertices of a base
/// triangle, normals that have no N's yet, edges. The new edges of a family (datapath/family.h) continue the last.
/// (Decision: a part is an item, since the tests work edge by edge and Transform vertex by vertex, which whole
/// triangles would not model. With words as items, transfers would dominate the simulation time.)
using Parts = std::uint16_t;
constexpr unsigned first_normal_part = 3;
constexpr unsigned first_edge_part = 6;
constexpr unsigned last_edge_part = 14;
constexpr unsigned part_bits = 4;
constexpr Parts vertex_parts = 0007;
constexpr Parts normal_parts = 0070;
constexpr Parts triangle_edge_parts = 0700;
constexpr Parts edge_parts = 077700;
constexpr Parts all_parts = 077777;

/// The parts of a triangle that go to Calculate New P: those that are not known yet and, unless the triangle is
/// finished, the edges that are not final; in the family design, the edges that split.
constexpr Parts parts_of(const datapath::Triangle& triangle, Work work = Work::triangle) {
    unsigned parts = unsigned{triangle.split} << first_edge_part;
    if (work == Work::triangle)
        parts = triangle.finished ? 0 : triangle_edge_parts & ~(unsigned{triangle.final_edges} << first_edge_part);
    for (unsigned k = 0; k < 3; ++k) {
        const datapath::Vertex& vertex = triangle.vertices[k];
        if (!vertex.displaced_known)
            parts |= 1u << k;
        else if (!vertex.screen_normal_known)
            parts |= 1u << (first_normal_part + k);
    }
    return static_cast<Parts>(parts);
}

/// The parts that go to Tessellation Tests unit `number` of 1 or 3: all vertices and edges or, with three units, one
/// edge and its two vertices.
constexpr Parts parts_for_tests(unsigned number, unsigned units) {
    if (units == 1)
        return vertex_parts | edge_parts;
    return static_cast<Parts>(1u << (first_edge_part + number) | 1u << number | 1u << (number + 1) % 3);
}

/// In the family design: the edges that go to a lane of the tests.
constexpr Parts parts_for_lane(unsigned lane, unsigned lanes) {
    unsigned parts = 0;
    for (unsigned part = first_edge_part + lane; part <= last_edge_part; part += lanes)
        parts |= 1u << part;
    return static_cast<Parts>(parts);
}

/// The new edges of a family.
constexpr Parts parts_of(const datapath::FamilyEdges& edges) {
    return static_cast<Parts>(((1u << edges.count) - 1) << first_edge_part);
}

/// The last part in a set of parts.
constexpr Parts last_of(Parts parts) {
    while ((parts & (parts - 1)) != 0)
        parts = static_cast<Parts>(parts & (parts - 1));
    return parts;
}

/// Identifies a triangle between Get Triangle and Pass or Tessellate: the number of its pass modulo 2^tag_bits
/// (modules/timing/design.h), enough to distinguish all triangles that can be there at a time.
using Tag = std::uint32_t;

/// The model's numbers for a triangle, for waveforms and messages. They do not exist in hardware.
struct Origin {
    std::uint32_t pass = 0;  ///< passes begun before it, modulo 2^32
    std::uint32_t base = 0;  ///< index of the base triangle it descends from
};

template <class Codec, class Any>
constexpr void describe_origin(datapath::Fields<Codec>& fields, Any& origin) {
    fields.annotation("triangle", origin.pass);
    fields.annotation("base", origin.base);
}

/// Identifies the triangle of an item, and the part of it.
struct PartTag {
    Tag triangle = 0;
    std::uint8_t part = 0;  ///< 0 to 14
    Origin origin;

    constexpr Parts bit() const { return static_cast<Parts>(1u << part); }
    /// The number of the vertex, normal or edge, 0 to 2.
    constexpr unsigned index() const { return part % 3u; }
    constexpr bool is_vertex() const { return part < first_normal_part; }
    constexpr bool is_normal() const { return part >= first_normal_part && part < first_edge_part; }
    constexpr bool is_edge() const { return part >= first_edge_part; }
};

template <class Codec, class Any>
constexpr void describe_tag(datapath::Fields<Codec>& fields, Any& tag) {
    fields.tag("tag", tag.triangle, "identifies the triangle");
    fields.number("part", tag.part, part_bits, "vertex, normal or edge; see waveforms/parts.txt");
    describe_origin(fields, tag.origin);
}

/// Whether an item is a part of a triangle; otherwise it is a whole triangle.
template <class Item, class = void>
constexpr bool is_part = false;
template <class Item>
constexpr bool is_part<Item, std::void_t<decltype(std::declval<Item>().tag.bit())>> = true;

template <class Item>
constexpr Parts parts_in(const Item& item) {
    if constexpr (is_part<Item>)
        return item.tag.bit();
    else
        return all_parts;
}

}  // namespace tessera
