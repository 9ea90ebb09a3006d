#pragma once
#include <array>
#include <cstdint>
#include <type_traits>

#include "modules/datapath/fields.h"
#include "modules/datapath/height_test.h"
#include "modules/datapath/rank_view.h"
#include "modules/datapath/triangle_pass.h"
#include "modules/sockets/parts.h"

// The items of the streams. Each describes its fields once (modules/datapath/fields.h); its packed form, its width,
// its signals in a waveform and its rows in modules/sockets/README.md are derived from that description. An item
// carries all data that its consumer needs: data that units shared would have no wires, and the widths would be wrong.

namespace tessera {

/// Get Triangle to Calculate New P. A vertex or normal has only the first end's fields; n_i of a normal is N'. In the
/// family design n_j of a vertex is T, and n_i, n_j of an edge are N_ij, N'_ij.
struct GeometryOperands {
    static constexpr const char* name = "geometry operands";
    PartTag tag;
    datapath::Position p_i, p_j;
    datapath::Direction n_i, n_j;
    datapath::TexCoord t_i, t_j;
    std::int8_t handedness = 1;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.position("p_i", item.p_i, "P of the edge's first end, or of the vertex");
        fields.position("p_j", item.p_j, "P of the edge's second end");
        fields.direction("n_i", item.n_i,
                         "N of the first end or of the vertex; for a normal N'; for an edge in the family design N_ij");
        fields.direction("n_j", item.n_j,
                         "N of the second end; in the family design N'_ij for an edge, T for a vertex");
        fields.texture("t_i", item.t_i, "t of the first end or of the vertex");
        fields.texture("t_j", item.t_j, "t of the second end");
        fields.family_handedness("handedness", item.handedness, "handedness of a vertex's tangent frame");
    }
};

/// Calculate New P to Displace Vertex: one point of the base surface.
struct BasePoint {
    static constexpr const char* name = "base point";
    PartTag tag;
    datapath::Position p;
    datapath::Direction n;
    datapath::TexCoord t;
    datapath::Direction displaced_n{};
    std::int8_t handedness = 1;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.position("p", item.p, "P");
        fields.direction("n", item.n, "N; for an edge (N_i + N_j) / 2, not yet normalised; for a normal N'");
        fields.texture("t", item.t, "t");
        fields.midpoint_direction("displaced_n", item.displaced_n, "N' of a midpoint, T of a vertex");
        fields.family_handedness("handedness", item.handedness, "handedness of a vertex's tangent frame");
    }
};

/// Displace Vertex to Transform. In the family design displaced_n is N', also for a vertex.
struct DisplacedPoint : BasePoint {
    static constexpr const char* name = "displaced point";
    datapath::Position displaced;
    std::uint16_t code = 0;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        BasePoint::describe(fields, item);
        fields.position("displaced", item.displaced, "P'");
        fields.code("code", item.code, "d, if vertices carry it");
    }
};

/// Transform to Pass or Tessellate. n of a normal is N's; in the family design displaced_n is, and n of a vertex is N'.
struct ScreenPoint : DisplacedPoint {
    static constexpr const char* name = "screen point";
    datapath::ScreenPosition screen;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        DisplacedPoint::describe(fields, item);
        fields.screen("screen", item.screen, "P's");
    }
};

/// Transform to the View Test: a corner of a base triangle.
struct ScreenCorner {
    static constexpr const char* name = "screen corner";
    PartTag tag;
    datapath::ScreenPosition screen;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.screen("screen", item.screen, "P's");
    }
};

/// The values of one end of an edge that the tests need.
struct EdgeEnd {
    datapath::TexCoord t;
    datapath::Direction n, tangent;
    std::int8_t handedness = 1;
    datapath::Direction displaced_n;
    datapath::ScreenPosition screen;
    std::uint8_t generation = 0;
    std::uint16_t code = 0;

    static constexpr EdgeEnd of(const datapath::Vertex& v) {
        return {v.texture, v.normal, v.tangent, v.handedness, v.displaced_normal, v.screen, v.generation, v.code};
    }

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& end) {
        fields.texture("t", end.t, "t");
        fields.direction("n", end.n, "N");
        fields.direction("tangent", end.tangent, "T");
        fields.handedness("handedness", end.handedness, "handedness of the tangent frame");
        fields.direction("displaced_n", end.displaced_n, "N', if known");
        fields.screen("screen", end.screen, "P's, if known");
        fields.generation("generation", end.generation, "generation");
        fields.code("code", end.code, "d, if known and if vertices carry it");
    }
};

/// Get Triangle to Tessellation Tests: an edge, or a vertex of a base triangle, which has only the first end's fields.
/// In the family design Tessellation to Tessellation Tests, edges only.
struct TestOperands {
    static constexpr const char* name = "test operands";
    PartTag tag;
    std::uint8_t new_vertices = 0;  ///< of the triangle: bit k is set if vertex k has no P's, N' yet
    std::array<EdgeEnd, 2> ends;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.number("new_vertices", item.new_vertices, 3, "vertices whose P's and N' are not known yet");
        for (int k = 0; k < 2; ++k) {
            fields.of(k);
            EdgeEnd::describe(fields, item.ends[static_cast<std::size_t>(k)]);
        }
        fields.of(-1);
    }
};

/// Calculate New U to the Tex Coord Test.
struct TexCoordOperands {
    static constexpr const char* name = "tex coord operands";
    PartTag tag;
    datapath::TexCoord t_i, t_j, t_ij;
    std::uint8_t generation_i = 0, generation_j = 0;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.texture("t_i", item.t_i, "t of the first end");
        fields.texture("t_j", item.t_j, "t of the second end");
        fields.texture("t_ij", item.t_ij, "t of the midpoint");
        fields.generation("generation_i", item.generation_i, "generation of the first end");
        fields.generation("generation_j", item.generation_j, "generation of the second end");
    }
};

/// Calculate New U to the Summed Height Test, or the test in its place.
struct HeightOperands : datapath::HeightEdge {
    static constexpr const char* name = "height operands";
    PartTag tag;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.texture("t_i", item.t_i, "t of the first end");
        fields.texture("t_j", item.t_j, "t of the second end");
        fields.texture("t_ij", item.t_ij, "t of the midpoint");
        fields.code_flag("codes_known", item.codes_known, "d is known for both ends, if vertices carry it");
        fields.code("code_i", item.code_i, "d of the first end");
        fields.code("code_j", item.code_j, "d of the second end");
        fields.edge_in_view("ends", item.ends, "D_i + D_j and w_i + w_j, for a view-dependent Rank Test");
    }
};

/// Calculate New U to the Normal Test: an edge, or a vertex of a base triangle, which has only the first end's fields.
struct NormalOperands {
    static constexpr const char* name = "normal operands";
    PartTag tag;
    std::uint8_t new_vertices = 0;
    datapath::TexCoord t;
    datapath::Direction n_i, n_j, tangent_i, tangent_j;
    std::int8_t handedness_i = 1, handedness_j = 1;
    datapath::Direction displaced_n_i, displaced_n_j;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.number("new_vertices", item.new_vertices, 3, "vertices whose N' is not known yet");
        fields.texture("t", item.t, "t of the midpoint, or of the vertex");
        fields.direction("n_i", item.n_i, "N of the first end, or of the vertex");
        fields.direction("n_j", item.n_j, "N of the second end");
        fields.direction("tangent_i", item.tangent_i, "T of the first end, or of the vertex");
        fields.direction("tangent_j", item.tangent_j, "T of the second end");
        fields.handedness("handedness_i", item.handedness_i, "handedness of the tangent frame");
        fields.handedness("handedness_j", item.handedness_j, "handedness of the tangent frame");
        fields.direction("displaced_n_i", item.displaced_n_i, "N' of the first end, if known");
        fields.direction("displaced_n_j", item.displaced_n_j, "N' of the second end, if known");
    }
};

/// Calculate New U to the View Test.
struct ViewOperands {
    static constexpr const char* name = "view operands";
    PartTag tag;
    std::uint8_t new_vertices = 0;
    datapath::ScreenPosition screen_i, screen_j;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.number("new_vertices", item.new_vertices, 3, "vertices whose P's is not known yet");
        fields.screen("screen_i", item.screen_i, "P's of the first end, if known");
        fields.screen("screen_j", item.screen_j, "P's of the second end, if known");
    }
};

/// Tex Coord Test to Collect Tests.
struct TexCoordResult {
    static constexpr const char* name = "tex coord result";
    PartTag tag;
    datapath::TexCoord t_ij;
    bool tex_coord = false;
    bool generation = false;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.texture("t_ij", item.t_ij, "t of the midpoint");
        fields.flag("tex_coord", item.tex_coord, "TCT");
        fields.flag("generation", item.generation, "GT");
    }
};

/// Summed Height Test, or the test in its place, to Collect Tests.
struct HeightResult {
    static constexpr const char* name = "height result";
    PartTag tag;
    bool summed_height = false;
    std::uint16_t rank = 0;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.flag("summed_height", item.summed_height, "SHT");
        fields.rank("rank", item.rank, "rank of the midpoint, with a Rank Test");
    }
};

/// View Test to Collect Tests.
struct ViewResult {
    static constexpr const char* name = "view result";
    PartTag tag;
    bool view = false;
    datapath::EdgeInView ends{};

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.flag("view", item.view, "VT");
        fields.edge_in_view("ends", item.ends, "D_i + D_j and w_i + w_j, for a view-dependent Rank Test");
    }
};

/// Normal Test to Collect Tests.
struct NormalResult {
    static constexpr const char* name = "normal result";
    PartTag tag;
    datapath::Direction n{}, tangent{}, displaced_n{}, displaced_n_i{};
    bool normal = false;
    bool highlight = false;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.direction("n", item.n, "N_ij");
        fields.direction("tangent", item.tangent, "T_ij");
        fields.direction("displaced_n", item.displaced_n, "N'_ij");
        fields.direction("displaced_n_i", item.displaced_n_i, "N' of the first end");
        fields.flag("normal", item.normal, "NT");
        fields.highlight("highlight", item.highlight, "HT, with a Highlight Test");
    }
};

/// Tessellation Tests to Pass or Tessellate: the results of the four tests for one edge.
struct TestedEdge {
    static constexpr const char* name = "tested edge";
    PartTag tag;
    datapath::EdgeTests found;
    datapath::Direction displaced_n_i;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_tag(fields, item.tag);
        fields.texture("t", item.found.texture, "t_ij");
        fields.direction("n", item.found.normal, "N_ij");
        fields.direction("tangent", item.found.tangent, "T_ij");
        fields.direction("displaced_n", item.found.displaced_normal, "N'_ij");
        fields.tests("tests", item.found.tests, "NT, SHT, VT, TCT, GT, HT");
        fields.rank("rank", item.found.rank, "rank of the midpoint, with a Rank Test");
        fields.direction("displaced_n_i", item.displaced_n_i, "N' of the first end");
        fields.annotation("evaluated", item.found.evaluated);
    }
};

/// Get Triangle to Pass or Tessellate: a triangle whose parts are sent; carries the values that its parts do not.
struct TakenTriangle {
    static constexpr const char* name = "taken triangle";
    Tag tag = 0;
    Origin origin;
    datapath::Triangle triangle;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        fields.tag("tag", item.tag, "identifies the triangle");
        describe_origin(fields, item.origin);
        describe_triangle(fields, item.triangle);
    }
};

/// Pass or Tessellate to Tessellation: a triangle and the vertices to insert on its edges. Of `pass` only the fields
/// described are carried.
struct DecidedTriangle {
    static constexpr const char* name = "decided triangle";
    Origin origin;
    datapath::TrianglePass pass;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_origin(fields, item.origin);
        if constexpr (!std::is_const_v<Any>)
            item.pass.number = item.origin.pass;
        describe_triangle(fields, item.pass.triangle);
        fields.number("split", item.pass.split, 3, "bit k: edge k is split");
        for (int k = 0; k < 3; ++k) {
            fields.of(k);
            auto& made = item.pass.new_vertex[static_cast<std::size_t>(k)];
            auto& edge = item.pass.edges[static_cast<std::size_t>(k)];
            fields.position("inserted_p", made.position, "P_ij");
            fields.texture("inserted_t", made.texture, "t_ij");
            fields.code("inserted_code", made.code, "d_ij, if vertices carry it");
            fields.position("inserted_displaced", made.displaced, "P'_ij");
            fields.screen("inserted_screen", made.screen, "P's_ij");
            fields.direction("inserted_n", edge.normal, "N_ij");
            fields.direction("inserted_tangent", edge.tangent, "T_ij");
            fields.direction("inserted_displaced_n", edge.displaced_normal, "N'_ij");
            fields.tests("tests", edge.tests, "NT, SHT, VT, TCT, GT, HT");
        }
        fields.of(-1);
    }
};

/// Tessellation to Pass or Tessellate, in the family design: a triangle and the vertices inserted on its split edges;
/// or a base triangle, whose edges are new.
struct Family {
    static constexpr const char* name = "family";
    Tag tag = 0;
    Origin origin;
    std::array<datapath::Vertex, 6> vertices;  ///< in the order of ChildIndices
    datapath::Triangle triangle;               ///< all but its vertices and midpoints
    bool second_diagonal = false;
    bool untested = false;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        fields.tag("tag", item.tag, "identifies the triangle");
        describe_origin(fields, item.origin);
        for (int k = 0; k < 6; ++k) {
            fields.of(k);
            describe_vertex(fields, item.vertices[static_cast<std::size_t>(k)]);
        }
        fields.of(-1);
        fields.requesting("split_by", item.triangle.split_by, "tests that split it");
        fields.gating("stopped_by", item.triangle.stopped_by, "tests that stopped an edge from splitting");
        fields.number("split", item.triangle.split, 3, "bit k: edge k is split");
        fields.uncut_edges("uncut", item.triangle.uncut, "bit k: edge k is to be tested again");
        fields.flag("second_diagonal", item.second_diagonal, "the quadrilateral is cut along its second diagonal");
        fields.flag("untested", item.untested, "a base triangle, whose edges are not tested yet");
        fields.annotation("triangle_base", item.triangle.base);
        fields.annotation("parent", item.triangle.parent);
    }
};

/// From host, Tessellation and Triangle Queue: a triangle as it waits in the queue. For a base triangle the host sets
/// P, N, T, handedness and t of each vertex.
struct QueuedTriangle {
    static constexpr const char* name = "triangle";

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& triangle) {
        describe_triangle(fields, triangle);
    }
};

/// Pass or Tessellate to Lighting: a finished triangle that is not culled.
struct TriangleToLight {
    static constexpr const char* name = "triangle to light";
    struct Corner {
        datapath::ScreenPosition screen;
        datapath::Direction screen_n;
        datapath::TexCoord t;
    };
    Origin origin;
    std::array<Corner, 3> corners;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_origin(fields, item.origin);
        for (int k = 0; k < 3; ++k) {
            fields.of(k);
            auto& corner = item.corners[static_cast<std::size_t>(k)];
            fields.pixel("screen", corner.screen, "P's");
            fields.direction("screen_n", corner.screen_n, "N's");
            fields.texture("t", corner.t, "t");
        }
        fields.of(-1);
    }
};

/// Lighting to the rasteriser.
struct LitTriangle {
    static constexpr const char* name = "lit triangle";
    struct Corner {
        datapath::ScreenPosition screen;
        datapath::TexCoord texture;
        std::uint8_t intensity = 0;
    };
    Origin origin;
    std::array<Corner, 3> corners;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        describe_origin(fields, item.origin);
        for (int k = 0; k < 3; ++k) {
            fields.of(k);
            auto& corner = item.corners[static_cast<std::size_t>(k)];
            fields.pixel("screen", corner.screen, "P's");
            fields.texture("t", corner.texture, "t");
            fields.number("intensity", corner.intensity, 8, "light intensity, 255 is the brightest");
        }
        fields.of(-1);
    }
};

/// Triangle Queue to Get Triangle, whenever it changes: whether a triangle may be accepted from the host.
struct QueueLevel {
    static constexpr const char* name = "queue level";
    bool below_watermark = true;

    template <class Codec, class Any>
    static constexpr void describe(datapath::Fields<Codec>& fields, Any& item) {
        fields.flag("below_watermark", item.below_watermark, "the queue is below its watermark");
    }
};

/// The description of an item; QueuedTriangle describes the datapath's triangle.
template <class Item>
struct DescriptionOf {
    using Type = Item;
};
template <>
struct DescriptionOf<datapath::Triangle> {
    using Type = QueuedTriangle;
};

// Applies a macro to the item of every stream.
#define TESSERA_FOR_EACH_STREAM_ITEM(macro)                                                                           \
    macro(datapath::Triangle) macro(QueueLevel) macro(TakenTriangle) macro(GeometryOperands) macro(BasePoint)         \
        macro(DisplacedPoint) macro(ScreenPoint) macro(ScreenCorner) macro(TestOperands) macro(TexCoordOperands)      \
            macro(HeightOperands) macro(NormalOperands) macro(ViewOperands) macro(TexCoordResult) macro(HeightResult) \
                macro(NormalResult) macro(ViewResult) macro(TestedEdge) macro(DecidedTriangle) macro(Family)          \
                    macro(TriangleToLight) macro(LitTriangle)

template <class ItemOfStream>
struct ItemType {
    using Item = ItemOfStream;
};
template <class Before, class... Items>
struct ItemTypes {
    template <class Each>
    static void for_each(Each&& each) {
        (each(ItemType<Items>{}), ...);
    }
};
/// The item of every stream: `StreamItems::for_each([](auto type) { using Item = typename decltype(type)::Item; ...
/// })`.
#define TESSERA_ITEM_AFTER_COMMA(Item) , Item
using StreamItems = ItemTypes<void TESSERA_FOR_EACH_STREAM_ITEM(TESSERA_ITEM_AFTER_COMMA)>;
#undef TESSERA_ITEM_AFTER_COMMA

/// Whether a stream's payload describes its fields.
template <class Item, class = void>
constexpr bool is_described = false;
template <class Item>
constexpr bool is_described<Item, std::void_t<decltype(DescriptionOf<Item>::Type::name)>> = true;

/// Passes an item's fields to a codec.
template <class Codec, class Item>
constexpr void describe_item(Codec& codec, Item& item, const datapath::Formats& formats, int tag_bits) {
    datapath::Fields<Codec> fields(codec, formats, tag_bits);
    DescriptionOf<std::remove_const_t<Item>>::Type::describe(fields, item);
}

/// Bits in an item, and so the wires of its stream.
template <class Item>
constexpr std::uint32_t item_bits(const datapath::Formats& formats, int tag_bits) {
    datapath::WidthCounter counter;
    const Item item{};
    describe_item(counter, item, formats, tag_bits);
    return counter.bits;
}

}  // namespace tessera
