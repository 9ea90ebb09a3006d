#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "modules/datapath/pack_triangle.h"
#include "testbench/common/random.h"

using namespace tessera::datapath;
using tessera::Random;

namespace {

struct Bits {
    int position, view_distance, normal, texture, screen, generation;
};

Formats make_formats(const Bits& bits) {
    Formats formats;
    formats.position = Format::make_signed(bits.position, 0);
    formats.view_distance = Format::make_signed(bits.view_distance, 0);
    formats.normal = Format::make_signed(bits.normal, 0);
    formats.texture = Format::make_unsigned(bits.texture, 0);
    formats.screen = Format::make_signed(bits.screen, 0);
    formats.generation_bits = bits.generation;
    return formats;
}

/// The defaults, the narrowest and widest of a job and of the packing, one with distinct widths, and random ones.
std::vector<Formats> many_formats() {
    std::vector<Formats> all = {Formats{},
                                make_formats({8, 8, 6, 2, 8, 1}),
                                make_formats({32, 32, 18, 25, 31, 4}),
                                make_formats({1, 1, 1, 1, 1, 1}),
                                make_formats({32, 32, 32, 32, 32, 8}),
                                make_formats({31, 27, 13, 17, 19, 5}),
                                make_formats({9, 32, 11, 23, 29, 7})};
    Random random(5);
    const auto width = [&random](int most) { return static_cast<int>(random.integer(1, most)); };
    for (int k = 0; k < 40; ++k)
        all.push_back(make_formats({width(32), width(32), width(32), width(32), width(32), width(8)}));
    for (std::size_t k = 1; k < all.size(); k += 2)
        all[k].final_edges = true;
    for (std::size_t k = 2; k < all.size(); k += 3)
        all[k].codes = true;
    for (std::size_t k = 3; k < all.size(); k += 4)
        all[k].highlight_tag = true;
    return all;
}

/// One field, in the order and width in which the header describes it.
struct ExpectedField {
    std::string name;
    int bits;
    std::int64_t lowest, highest;  ///< what it may hold
    std::function<std::int64_t(const Triangle&)> get;
    std::function<void(Triangle&, std::int64_t)> set;
    std::vector<std::int64_t> misfits;  ///< of the values its variable may hold
};

/// Values that `Number` holds but `bits` bits do not: those next to the range, and the extremes.
template <class Number>
std::vector<std::int64_t> misfits_of(std::int64_t lowest, std::int64_t highest) {
    const std::int64_t least = std::numeric_limits<Number>::min(), most = std::numeric_limits<Number>::max();
    std::vector<std::int64_t> misfits;
    if (least < lowest)
        misfits.insert(misfits.end(), {lowest - 1, least});
    if (most > highest)
        misfits.insert(misfits.end(), {highest + 1, most});
    return misfits;
}

template <class Number>
ExpectedField number(std::string name, int bits, std::function<Number&(Triangle&)> where) {
    const std::int64_t values = std::int64_t{1} << bits;
    const bool has_sign = std::numeric_limits<Number>::is_signed;
    const std::int64_t lowest = has_sign ? -values / 2 : 0, highest = lowest + values - 1;
    std::vector<std::int64_t> misfits;
    if constexpr (!std::is_same_v<Number, bool>)
        misfits = misfits_of<Number>(lowest, highest);
    return {std::move(name),
            bits,
            lowest,
            highest,
            [where](const Triangle& triangle) {
                Triangle copy = triangle;
                return std::int64_t{where(copy)};
            },
            [where](Triangle& triangle, std::int64_t value) { where(triangle) = static_cast<Number>(value); },
            misfits};
}

template <class Vector>
void add_vector(std::vector<ExpectedField>& fields, const std::string& name, int bits, std::size_t vertex,
                Vector Vertex::*member) {
    const auto component = [&](const char* letter, std::int32_t Vector::*coordinate) {
        fields.push_back(number<std::int32_t>(name + letter, bits,
                                              [vertex, member, coordinate](Triangle& triangle) -> std::int32_t& {
                                                  return triangle.vertices[vertex].*member.*coordinate;
                                              }));
    };
    component(".x", &Vector::x);
    component(".y", &Vector::y);
    component(".z", &Vector::z);
}

std::vector<ExpectedField> fields_of(const Formats& formats) {
    std::vector<ExpectedField> fields;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::string vertex = "vertex " + std::to_string(k) + " ";
        const int position = formats.position.bits, normal = formats.normal.bits;
        add_vector(fields, vertex + "P", position, k, &Vertex::position);
        add_vector(fields, vertex + "N", normal, k, &Vertex::normal);
        add_vector(fields, vertex + "T", normal, k, &Vertex::tangent);
        fields.push_back(
            {vertex + "handedness",
             1,
             0,
             1,
             [k](const Triangle& t) { return (1 - t.vertices[k].handedness) / 2; },
             [k](Triangle& t, std::int64_t code) { t.vertices[k].handedness = static_cast<std::int8_t>(1 - 2 * code); },
             {2, -1, 64, -63}});
        const auto natural = [&](const char* name, auto member) {
            fields.push_back(number<std::uint32_t>(
                vertex + name, formats.texture.bits,
                [k, member](Triangle& t) -> std::uint32_t& { return t.vertices[k].texture.*member; }));
        };
        natural("t.u", &TexCoord::u);
        natural("t.v", &TexCoord::v);
        fields.push_back(number<std::uint8_t>(vertex + "generation", formats.generation_bits,
                                              [k](Triangle& t) -> std::uint8_t& { return t.vertices[k].generation; }));
        const auto flag = [&](const char* name, auto member) {
            fields.push_back(
                number<bool>(vertex + name, 1, [k, member](Triangle& t) -> bool& { return t.vertices[k].*member; }));
        };
        flag("displaced known", &Vertex::displaced_known);
        flag("screen normal known", &Vertex::screen_normal_known);
        if (formats.codes)
            fields.push_back(number<std::uint16_t>(vertex + "d", formats.displacement.bits,
                                                   [k](Triangle& t) -> std::uint16_t& { return t.vertices[k].code; }));
        add_vector(fields, vertex + "P'", position, k, &Vertex::displaced);
        add_vector(fields, vertex + "N'", normal, k, &Vertex::displaced_normal);
        const auto screen = [&](const char* name, auto member, int bits) {
            fields.push_back(number<std::int32_t>(vertex + name, bits, [k, member](Triangle& t) -> std::int32_t& {
                return t.vertices[k].screen.*member;
            }));
        };
        screen("P's.x", &ScreenPosition::x, formats.screen.bits);
        screen("P's.y", &ScreenPosition::y, formats.screen.bits);
        screen("w", &ScreenPosition::w, formats.view_distance.bits);
        fields.push_back(
            number<bool>(vertex + "in front", 1, [k](Triangle& t) -> bool& { return t.vertices[k].screen.in_front; }));
        add_vector(fields, vertex + "N's", normal, k, &Vertex::screen_normal);
    }
    // codes of 2 bits, or of 3 with that of the Highlight Test, whose value is 32
    const int requesting = formats.highlight_tag ? 3 : 2;
    fields.push_back({"split by",
                      requesting,
                      0,
                      (1 << requesting) - 1,
                      [](const Triangle& t) { return t.split_by % 4 + t.split_by / 32 * 4; },
                      [](Triangle& t, std::int64_t code) {
                          t.split_by = static_cast<std::uint8_t>(code % 4 + code / 4 * highlight_bit);
                      },
                      {1 << requesting}});
    // codes of 3 bits represent 4, 8, 16: a quarter of the value
    ExpectedField stopped_by{"stopped by",
                             3,
                             0,
                             7,
                             [](const Triangle& t) { return t.stopped_by / 4; },
                             [](Triangle& t, std::int64_t code) { t.stopped_by = static_cast<std::uint8_t>(4 * code); },
                             {8, 63}};
    fields.push_back(stopped_by);
    fields.push_back(number<bool>("finished", 1, [](Triangle& t) -> bool& { return t.finished; }));
    if (formats.final_edges)
        fields.push_back(
            number<std::uint8_t>("final edges", 3, [](Triangle& t) -> std::uint8_t& { return t.final_edges; }));
    return fields;
}

/// The reference: '0' and '1' in order, lowest bit first, by halving.
std::string bits_of(const Triangle& triangle, const std::vector<ExpectedField>& fields) {
    std::string text;
    for (const ExpectedField& field : fields) {
        std::int64_t value = field.get(triangle);
        for (int k = 0; k < field.bits; ++k) {
            const bool odd = value % 2 != 0;
            text += odd ? '1' : '0';
            value = (value - (odd ? 1 : 0)) / 2;
        }
    }
    return text;
}

constexpr unsigned char guard = 0xa5;
constexpr std::size_t guard_bytes = 16;

/// A packed triangle between two guard areas, in memory with random content.
struct Packed {
    explicit Packed(const Formats& formats)
        : size(packed_triangle_bytes(formats) + packed_triangle_tag_bytes), memory(size + 2 * guard_bytes, guard) {}

    unsigned char* bytes() { return memory.data() + guard_bytes; }
    bool fenced() const {
        const auto at_guard = [](unsigned char byte) { return byte == guard; };
        return std::all_of(memory.begin(), memory.begin() + guard_bytes, at_guard) &&
               std::all_of(memory.end() - guard_bytes, memory.end(), at_guard);
    }
    std::string bits(std::size_t first, std::size_t count) {
        std::string text;
        for (std::size_t k = first; k < first + count; ++k)
            text += (bytes()[k / 8] >> (k % 8) & 1) != 0 ? '1' : '0';
        return text;
    }
    void flip(std::size_t bit) { bytes()[bit / 8] = static_cast<unsigned char>(bytes()[bit / 8] ^ 1 << (bit % 8)); }

    std::size_t size;
    std::vector<unsigned char> memory;
};

/// Names of the fields in which two triangles differ, each followed by a semicolon.
std::string difference(const Triangle& a, const Triangle& b, const std::vector<ExpectedField>& fields) {
    std::string names = a.base == b.base ? "" : "base;";
    names += a.parent == b.parent ? "" : "parent;";
    for (const ExpectedField& field : fields)
        if (field.get(a) != field.get(b))
            names += field.name + ";";
    return names;
}

Triangle random_triangle(Random& random, const std::vector<ExpectedField>& fields) {
    Triangle triangle;
    for (const ExpectedField& field : fields)
        field.set(triangle, random.coin()
                                ? random.integer(field.lowest, field.highest)
                                : std::clamp(random.any_size(field.highest + 1), field.lowest, field.highest));
    triangle.base = random.natural(0, 0xffffffffU);
    triangle.parent = random.natural(0, 0xffffffffU);
    return triangle;
}

/// Packs as the reference does, writes nothing else, and unpacks to the same triangle.
void check_round_trip(const Triangle& triangle, const Formats& formats, const std::vector<ExpectedField>& fields) {
    Packed packed(formats);
    if (!pack_triangle(triangle, formats, packed.bytes()))
        FAIL("said not to fit");
    const std::string expected = bits_of(triangle, fields);
    const std::size_t whole = packed_triangle_bytes(formats) * 8;
    if (packed.bits(0, whole) != expected + std::string(whole - expected.size(), '0'))
        FAIL("bits " << packed.bits(0, whole) << "\nnot  " << expected);
    if (packed.bits(whole, 32) != bits_of(triangle, {number<std::uint32_t>(
                                                        "base", 32, [](Triangle & t) -> auto& { return t.base; })}))
        FAIL("base");
    if (packed.bits(whole + 32, 32) !=
        bits_of(triangle, {number<std::uint32_t>(
                              "parent", 32, [](Triangle & t) -> auto& { return t.parent; })}))
        FAIL("parent");
    if (!packed.fenced())
        FAIL("written outside");
    const Triangle back = unpack_triangle(packed.bytes(), formats);
    if (const std::string names = difference(back, triangle, fields); !names.empty())
        FAIL("lost: " << names);
}

constexpr bool survives_at_compile_time() {
    Triangle triangle;
    triangle.vertices[2].displaced.z = -5;
    triangle.base = 77;
    triangle.finished = true;
    std::array<unsigned char, packed_triangle_bytes(Formats{}) + packed_triangle_tag_bytes> bytes{};
    const bool fits = pack_triangle(triangle, Formats{}, bytes.data());
    const Triangle back = unpack_triangle(bytes.data(), Formats{});
    return fits && back.vertices[2].displaced == Position{0, 0, -5} && back.base == 77 && back.finished &&
           !back.vertices[2].displaced_known;
}

}  // namespace

TEST_CASE("pack triangle: a queue entry has the declared width, rounded up to whole bytes") {
    CHECK(packed_triangle_bytes(Formats{}) == 197);  // 1572 bits
    static_assert(survives_at_compile_time());
    for (const Formats& formats : many_formats()) {
        std::size_t bits = 0;
        for (const ExpectedField& field : fields_of(formats))
            bits += static_cast<std::size_t>(field.bits);
        CHECK(bits == stream_widths(formats).triangle);
        CHECK(packed_triangle_bytes(formats) * 8 >= bits);
        CHECK(packed_triangle_bytes(formats) * 8 < bits + 8);
    }
}

TEST_CASE("pack triangle: field positions computed by hand in the default formats") {
    const Formats formats;
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

TEST_CASE("pack triangle: random triangles, compared with bits written one by one") {
    Random random(1);
    for (const Formats& formats : many_formats()) {
        const std::vector<ExpectedField> fields = fields_of(formats);
        for (int k = 0; k < 60; ++k)
            check_round_trip(random_triangle(random, fields), formats, fields);
    }
}

TEST_CASE("pack triangle: the limits of every field, alone and with all others at their limits") {
    for (const Formats& formats : many_formats()) {
        const std::vector<ExpectedField> fields = fields_of(formats);
        for (const int rest : {0, 1, 2}) {
            Triangle triangle;
            for (const ExpectedField& field : fields)
                field.set(triangle, rest == 0 ? 0 : rest == 1 ? field.lowest : field.highest);
            triangle.base = rest == 2 ? 0xffffffffU : 0;
            check_round_trip(triangle, formats, fields);
            for (const ExpectedField& field : fields)
                for (const std::int64_t value : {field.lowest, field.highest}) {
                    Triangle changed = triangle;
                    field.set(changed, value);
                    check_round_trip(changed, formats, fields);
                }
        }
    }
}

TEST_CASE("pack triangle: every bit up to the width belongs to one field, none beyond it to any") {
    Random random(2);
    for (const Formats& formats : many_formats()) {
        const std::vector<ExpectedField> fields = fields_of(formats);
        const Triangle triangle = random_triangle(random, fields);
        Packed packed(formats);
        REQUIRE(pack_triangle(triangle, formats, packed.bytes()));
        std::size_t bit = 0;
        const auto check_flip = [&](const std::string& expected) {
            packed.flip(bit);
            const std::string names = difference(unpack_triangle(packed.bytes(), formats), triangle, fields);
            packed.flip(bit);
            if (names != expected)
                FAIL("bit " << bit << " changes '" << names << "', not '" << expected << "'");
            ++bit;
        };
        for (const ExpectedField& field : fields)
            for (int k = 0; k < field.bits; ++k)
                check_flip(field.name + ";");
        REQUIRE(bit == stream_widths(formats).triangle);
        while (bit < packed_triangle_bytes(formats) * 8)
            check_flip("");
        while (bit < (packed_triangle_bytes(formats) + 4) * 8)
            check_flip("base;");
        while (bit < packed.size * 8)
            check_flip("parent;");
    }
}

TEST_CASE("pack triangle: a value that does not fit is reported and changes no other field") {
    Random random(3);
    std::size_t reported = 0;
    for (const Formats& formats : many_formats()) {
        const std::vector<ExpectedField> fields = fields_of(formats);
        const Triangle good = random_triangle(random, fields);
        for (const ExpectedField& field : fields)
            for (const std::int64_t value : field.misfits) {
                Triangle bad = good;
                field.set(bad, value);
                Packed packed(formats);
                if (pack_triangle(bad, formats, packed.bytes()))
                    FAIL(field.name << " = " << value << " in " << field.bits << " bits passes");
                ++reported;
                if (!packed.fenced())
                    FAIL("written outside");
                const std::string lowest = bits_of(bad, fields);
                if (field.bits > 1 && packed.bits(0, lowest.size()) != lowest)
                    FAIL(field.name << " = " << value << " keeps other bits than the lowest");
                const std::string names = difference(unpack_triangle(packed.bytes(), formats), good, fields);
                if (!names.empty() && names != field.name + ";")
                    FAIL(field.name << " = " << value << " spoils " << names);
            }
    }
    CHECK(reported > 5000);
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
