#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "modules/datapath/pack_triangle.h"

// Positions and members of a queue entry. modules/sockets/test_stream_items.cpp has every stream's item, also this one,
// with random values in many formats.

using namespace tessera::datapath;

namespace {

auto members_of(const Vertex& v) {
    return std::tie(v.position, v.normal, v.tangent, v.texture, v.handedness, v.generation, v.displaced_known,
                    v.screen_normal_known, v.code, v.displaced, v.displaced_normal, v.screen, v.screen_normal);
}

void check_equal(const Triangle& a, const Triangle& b) {
    for (std::size_t k = 0; k < 3; ++k)
        CHECK((members_of(a.vertices[k]) == members_of(b.vertices[k])));
    CHECK(std::tie(a.base, a.split_by, a.stopped_by, a.finished, a.final_edges, a.parent) ==
          std::tie(b.base, b.split_by, b.stopped_by, b.finished, b.final_edges, b.parent));
}

/// A packed triangle, followed by a guard.
struct Packed {
    explicit Packed(const Formats& formats)
        : size(packed_triangle_bytes(formats) + packed_triangle_tag_bytes), memory(size + 16, guard) {}

    unsigned char* bytes() { return memory.data(); }
    bool guarded() const {
        return std::all_of(memory.data() + size, memory.data() + memory.size(),
                           [](unsigned char byte) { return byte == guard; });
    }

    static constexpr unsigned char guard = 0xa5;
    std::size_t size;
    std::vector<unsigned char> memory;
};

}  // namespace

TEST_CASE("pack triangle: field positions computed by hand in the default formats") {
    constexpr Formats formats;
    static_assert(packed_triangle_bytes(formats) == 197);  // 1572 bits
    Packed packed(formats);
    Triangle triangle;
    triangle.vertices[0].position = {0x12345678, -2, 0};
    triangle.vertices[1].handedness = -1;
    triangle.split_by = summed_height_bit;
    triangle.stopped_by = view_bit | generation_bit;
    triangle.finished = true;
    triangle.base = 0xfedcba98U;
    triangle.parent = 0x01020304U;
    REQUIRE(pack_triangle(triangle, formats, packed.bytes()));
    std::vector<unsigned char> expected(205, 0);
    expected[0] = 0x78;
    expected[1] = 0x56;
    expected[2] = 0x34;
    expected[3] = 0x12;
    expected[4] = 0xfe;
    expected[5] = expected[6] = expected[7] = 0xff;
    expected[(522 + 192) / 8] = 1 << ((522 + 192) % 8);  // after P, N, T of the second vertex
    expected[195] = 0b10 << 6;                           // bits 1566 and 1567
    expected[196] = 0b1101;                              // VT, GT, finished
    expected[197] = 0x98;
    expected[198] = 0xba;
    expected[199] = 0xdc;
    expected[200] = 0xfe;
    expected[201] = 0x04;
    expected[202] = 0x03;
    expected[203] = 0x02;
    expected[204] = 0x01;
    CHECK(std::vector<unsigned char>(packed.bytes(), packed.bytes() + packed.size) == expected);
}

TEST_CASE("pack triangle: every member is restored, and one that does not fit changes no other") {
    Formats formats;
    formats.codes = formats.final_edges = formats.highlight_tag = true;
    for (int bits = 3; bits <= 8; ++bits) {  // other bits left in the last word
        formats.generation_bits = bits;
        Triangle triangle;
        std::int32_t number = 0;
        for (Vertex& vertex : triangle.vertices) {
            const auto fill = [&number](auto& v) { v = {number + 1, -number - 2, number += 3}; };
            fill(vertex.position);
            fill(vertex.normal);
            fill(vertex.tangent);
            vertex.texture = {0xa00, 0xb00};
            vertex.handedness = number % 2 == 0 ? -1 : 1;
            vertex.generation = 5;
            vertex.displaced_known = number % 2 != 0;
            vertex.screen_normal_known = number % 2 == 0;
            vertex.code = 0xc00;
            fill(vertex.displaced);
            fill(vertex.displaced_normal);
            vertex.screen = {100, -200, ++number, number % 2 != 0, 0};
            fill(vertex.screen_normal);
        }
        triangle.base = 0xfedcba98U;
        triangle.split_by = highlight_bit | normal_bit;
        triangle.stopped_by = tex_coord_bit | generation_bit;
        triangle.finished = true;
        triangle.final_edges = 6;
        triangle.parent = 0x01020304U;
        Packed packed(formats);
        CHECK(pack_triangle(triangle, formats, packed.bytes()));
        CHECK(packed.guarded());
        check_equal(unpack_triangle(packed.bytes(), formats), triangle);

        Triangle too_wide = triangle;
        too_wide.vertices[1].displaced_normal.y += 1 << formats.normal.bits;
        CHECK_FALSE(pack_triangle(too_wide, formats, packed.bytes()));
        CHECK(packed.guarded());
        check_equal(unpack_triangle(packed.bytes(), formats), triangle);
    }
}

TEST_CASE("pack triangle: of a field in eight bits only the values that it stands for fit") {
    for (int bits = 1; bits <= 8; ++bits) {
        Formats formats;
        formats.generation_bits = bits;
        formats.highlight_tag = bits % 2 == 0;
        Packed packed(formats);
        const unsigned requesting = requesting_tests & ~(formats.highlight_tag ? 0u : unsigned{highlight_bit});
        for (unsigned value = 0; value < 256; ++value) {
            Triangle split, stopped, turned, old;
            split.split_by = stopped.stopped_by = old.vertices[1].generation = static_cast<std::uint8_t>(value);
            turned.vertices[2].handedness = static_cast<std::int8_t>(value);
            CHECK(pack_triangle(split, formats, packed.bytes()) == ((value & ~requesting) == 0));
            CHECK(pack_triangle(stopped, formats, packed.bytes()) == ((value & ~unsigned{gating_tests}) == 0));
            CHECK(pack_triangle(turned, formats, packed.bytes()) == (value == 1 || value == 255));  // 1 or -1
            CHECK(pack_triangle(old, formats, packed.bytes()) == (value >> bits == 0));
        }
    }
}
