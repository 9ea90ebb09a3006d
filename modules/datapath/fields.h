#pragma once
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "modules/datapath/format.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// One field of an item: a wire or a bundle of wires.
struct Field {
    const char* name;       ///< of the value, such as "displaced"
    const char* component;  ///< of a vector, such as "x"; else ""
    int index;              ///< 0 to 2 of three equal fields, 0 to 5 of a family's vertices; else -1
    int bits;               ///< in the job's formats
    int most_bits;          ///< in the widest formats, as a waveform declares it
    bool is_signed;
    const char* meaning;
};

/// Describes an item to a codec: each of its fields once, the lowest bit first. For each field it calls the codec's
///
///     std::int64_t field(const Field&, std::int64_t value)
///
/// and stores the returned value in the item, unless the item is constant. A writer returns the same value, a reader
/// the value it has read. One list of an item's fields thus serves packing, unpacking, widths and waveforms.
///
/// `annotation` describes a value of the model that the hardware does not have; its width is 0. It calls the codec's
///
///     std::uint32_t annotation(const char* name, std::uint32_t value)
template <class Codec>
class Fields {
  public:
    constexpr Fields(Codec& codec, const Formats& formats, int tag_bits = 32)
        : codec_(codec), formats_(formats), tag_bits_(tag_bits) {}

    /// The fields that follow belong to vertex or edge `index`; -1: to the item itself.
    constexpr void of(int index) { index_ = index; }

    template <class P>
    constexpr void position(const char* name, P& p, const char* meaning) {
        vector(name, p, formats_.position.bits, FormatLimits::position_bits.most, meaning);
    }
    template <class D>
    constexpr void direction(const char* name, D& n, const char* meaning) {
        vector(name, n, formats_.normal.bits, FormatLimits::normal_bits.most, meaning);
    }
    template <class T>
    constexpr void texture(const char* name, T& t, const char* meaning) {
        constexpr int most = FormatLimits::texture_integer.most + FormatLimits::texture_fraction.most + 1;
        pass(named(name, "u", formats_.texture.bits, most, false, meaning), t.u);
        pass(named(name, "v", formats_.texture.bits, most, false, meaning), t.v);
    }
    /// P's; with a view-dependent Rank Test also D.
    template <class S>
    constexpr void screen(const char* name, S& s, const char* meaning) {
        pixel(name, s, meaning);
        if (formats_.distances)
            pass(named(name, "distance", formats_.view_distance.bits, FormatLimits::position_bits.most, false, meaning),
                 s.distance);
    }
    template <class S>
    constexpr void pixel(const char* name, S& s, const char* meaning) {
        pass(named(name, "x", formats_.screen.bits, FormatLimits::screen_bits.most, true, meaning), s.x);
        pass(named(name, "y", formats_.screen.bits, FormatLimits::screen_bits.most, true, meaning), s.y);
        pass(named(name, "w", formats_.view_distance.bits, FormatLimits::position_bits.most, true, meaning), s.w);
        pass(named(name, "in_front", 1, 1, false, meaning), s.in_front);
    }
    template <class N>
    constexpr void generation(const char* name, N& value, const char* meaning) {
        pass(named(name, "", formats_.generation_bits, 8, false, meaning), value);
    }
    template <class N>
    constexpr void number(const char* name, N& value, int bits, const char* meaning) {
        pass(named(name, "", bits, bits, false, meaning), value);
    }
    template <class B>
    constexpr void flag(const char* name, B& value, const char* meaning) {
        pass(named(name, "", 1, 1, false, meaning), value);
    }
    /// HT: only in a design with a Highlight Test.
    template <class B>
    constexpr void highlight(const char* name, B& value, const char* meaning) {
        if (formats_.highlight_tag)
            flag(name, value, meaning);
    }
    /// Only in a design that keeps them.
    template <class N>
    constexpr void final_edges(const char* name, N& value, const char* meaning) {
        if (formats_.final_edges)
            number(name, value, 3, meaning);
    }
    /// Only in the family design.
    template <class N>
    constexpr void split_edges(const char* name, N& value, const char* meaning) {
        if (formats_.families)
            number(name, value, 3, meaning);
    }
    /// Only in the family design with a Rank Test.
    template <class N>
    constexpr void uncut_edges(const char* name, N& value, const char* meaning) {
        if (formats_.families && formats_.height_test == HeightTest::rank)
            number(name, value, 3, meaning);
    }
    /// Only with a Rank Test.
    template <class N>
    constexpr void rank(const char* name, N& value, const char* meaning) {
        if (formats_.height_test == HeightTest::rank)
            pass(named(name, "", ordering_bits(formats_), 16, false, meaning), value);
    }
    /// Only with a view-dependent Rank Test.
    template <class N>
    constexpr void edge_in_view(const char* name, N& ends, const char* meaning) {
        if (!formats_.distances)
            return;
        const int bits = formats_.view_distance.bits + 1, most = FormatLimits::position_bits.most + 1;
        pass(named(name, "distance", bits, most, false, meaning), ends.distance);
        pass(named(name, "depth", bits, most, true, meaning), ends.depth);
    }
    template <class D>
    constexpr void midpoint_direction(const char* name, D& n, const char* meaning) {
        if (formats_.families)
            direction(name, n, meaning);
    }
    template <class H>
    constexpr void family_handedness(const char* name, H& value, const char* meaning) {
        if (formats_.families)
            handedness(name, value, meaning);
    }
    /// Only in a design that keeps them.
    template <class N>
    constexpr void code(const char* name, N& value, const char* meaning) {
        if (formats_.codes)
            pass(named(name, "", formats_.displacement.bits, 16, false, meaning), value);
    }
    /// Whether codes are known: likewise.
    template <class B>
    constexpr void code_flag(const char* name, B& value, const char* meaning) {
        if (formats_.codes)
            flag(name, value, meaning);
    }
    /// 1 or -1; the bit is set for -1.
    template <class H>
    constexpr void handedness(const char* name, H& value, const char* meaning) {
        const std::int64_t bit = codec_.field(named(name, "", 1, 1, false, meaning), value == 1    ? 0
                                                                                     : value == -1 ? 1
                                                                                                   : 2);
        if constexpr (!std::is_const_v<H>)
            value = bit == 0 ? std::int8_t{1} : std::int8_t{-1};
    }
    /// NT and SHT; in a design with a Highlight Test also HT, as the bit above.
    template <class N>
    constexpr void requesting(const char* name, N& tests, const char* meaning) {
        constexpr std::uint8_t two = normal_bit | summed_height_bit;
        const int bits = formats_.highlight_tag ? 3 : 2;
        const std::int64_t read = codec_.field(
            named(name, "", bits, 3, false, meaning),
            (tests & two) | (tests & highlight_bit) / highlight_bit * 4 | (tests & ~requesting_tests) << 3);
        if constexpr (!std::is_const_v<N>)
            tests = static_cast<N>((read & two) | (read >> 2 & 1) * highlight_bit);
    }
    /// VT, TCT, GT.
    template <class N>
    constexpr void gating(const char* name, N& tests, const char* meaning) {
        const std::int64_t read = codec_.field(named(name, "", 3, 3, false, meaning), spread(tests));
        if constexpr (!std::is_const_v<N>)
            tests = static_cast<N>(read << 2);
    }
    /// All tests; HT only in a design with a Highlight Test.
    template <class N>
    constexpr void tests(const char* name, N& tests, const char* meaning) {
        pass(named(name, "", formats_.highlight_tag ? 6 : 5, 6, false, meaning), tests);
    }
    template <class N>
    constexpr void tag(const char* name, N& value, const char* meaning) {
        pass(named(name, "", tag_bits_, 32, false, meaning), value);
    }
    template <class N>
    constexpr void annotation(const char* name, N& value) {
        const std::uint32_t read = codec_.annotation(name, value);
        if constexpr (!std::is_const_v<N>)
            value = static_cast<N>(read);
    }

  private:
    template <class V>
    constexpr void vector(const char* name, V& v, int bits, int most, const char* meaning) {
        pass(named(name, "x", bits, most, true, meaning), v.x);
        pass(named(name, "y", bits, most, true, meaning), v.y);
        pass(named(name, "z", bits, most, true, meaning), v.z);
    }
    constexpr Field named(const char* name, const char* component, int bits, int most_bits, bool is_signed,
                          const char* meaning) const {
        return {name, component, index_, bits, most_bits, is_signed, meaning};
    }
    template <class N>
    constexpr void pass(const Field& field, N& value) {
        const std::int64_t read = codec_.field(field, static_cast<std::int64_t>(value));
        if constexpr (!std::is_const_v<N>)
            value = static_cast<N>(read);
    }
    /// Any bit other than VT, TCT, GT is placed beyond the field, so that a writer reports it.
    static constexpr std::int64_t spread(std::uint8_t tests) {
        return (tests & gating_tests) >> 2 | ((tests & ~gating_tests) != 0 ? 8 : 0);
    }

    Codec& codec_;
    const Formats& formats_;
    int tag_bits_;
    int index_ = -1;
};

/// The fields of a vertex that the host sends.
template <class Codec, class AnyVertex>
constexpr void describe_base_vertex(Fields<Codec>& fields, AnyVertex& vertex) {
    fields.position("p", vertex.position, "P");
    fields.direction("n", vertex.normal, "N");
    fields.direction("tangent", vertex.tangent, "T");
    fields.handedness("handedness", vertex.handedness, "bitangent = handedness (N x T)");
    fields.texture("t", vertex.texture, "t");
}

/// The fields of a vertex whose P', P's, N' are known.
template <class Codec, class AnyVertex>
constexpr void describe_displaced(Fields<Codec>& fields, AnyVertex& vertex) {
    fields.code("code", vertex.code, "d");
    fields.position("displaced", vertex.displaced, "P'");
    fields.direction("displaced_n", vertex.displaced_normal, "N'");
    fields.screen("screen", vertex.screen, "P's");
}

/// All fields of a vertex, as in the Triangle Queue.
template <class Codec, class AnyVertex>
constexpr void describe_vertex(Fields<Codec>& fields, AnyVertex& vertex) {
    describe_base_vertex(fields, vertex);
    fields.generation("generation", vertex.generation, "generation");
    fields.flag("displaced_known", vertex.displaced_known, "P', P's, N' are known");
    fields.flag("screen_normal_known", vertex.screen_normal_known, "N's is known");
    describe_displaced(fields, vertex);
    fields.direction("screen_n", vertex.screen_normal, "N's");
}

/// A Triangle Queue entry.
template <class Codec, class AnyTriangle>
constexpr void describe_triangle(Fields<Codec>& fields, AnyTriangle& triangle) {
    for (int k = 0; k < 3; ++k) {
        fields.of(k);
        describe_vertex(fields, triangle.vertices[static_cast<std::size_t>(k)]);
    }
    fields.of(-1);
    fields.requesting("split_by", triangle.split_by, "tests that split its parent");
    fields.gating("stopped_by", triangle.stopped_by, "tests that stopped an edge from splitting");
    fields.flag("finished", triangle.finished, "no edge splits");
    fields.final_edges("final_edges", triangle.final_edges, "bit k: edge k was tested before and does not split");
    fields.split_edges("split", triangle.split, "bit k: edge k is to be split");
    fields.uncut_edges("uncut", triangle.uncut, "bit k: edge k requests a split and is tested again");
    for (int k = 0; k < 3; ++k) {
        fields.of(k);
        auto& midpoint = triangle.midpoints[static_cast<std::size_t>(k)];
        fields.midpoint_direction("midpoint_n", midpoint.normal, "N of edge k's midpoint, if it is split");
        fields.midpoint_direction("midpoint_tangent", midpoint.tangent, "T of edge k's midpoint, if it is split");
        fields.midpoint_direction("midpoint_displaced_n", midpoint.displaced_normal,
                                  "N' of edge k's midpoint, if it is split");
    }
    fields.of(-1);
    fields.annotation("base", triangle.base);
    fields.annotation("parent", triangle.parent);
}

/// Adds up the widths of an item's fields.
struct WidthCounter {
    std::uint32_t bits = 0;

    constexpr std::int64_t field(const Field& field, std::int64_t value) {
        bits += static_cast<std::uint32_t>(field.bits);
        return value;
    }
    constexpr std::uint32_t annotation(const char*, std::uint32_t value) const { return value; }
};

}  // namespace tessera::datapath
