#pragma once
#include <cstddef>
#include <cstdint>

#include "modules/datapath/format.h"
#include "modules/datapath/vertex.h"
#include "modules/datapath/widths.h"

namespace tessera::datapath {

/// A Triangle Queue entry as bits, for its way to off-chip memory and back.
///
/// Layout, the lowest bit first, little endian, without gaps: vertices 0, 1, 2, each
///     P  N  T  handedness (1: negative)  t  generation  displaced_known  screen_normal_known
///     P'  N'  P's x, y, w, in front  N's
/// then split_by (2 bits: NT, SHT; with a Highlight Test a third: HT), stopped_by (3 bits: VT, TCT, GT), finished. Signed fields are two's complement.
/// Every width is its format's; together they are stream_widths().triangle. The last byte's unused bits are zero.
/// Widths: 1 to 32 bits, of the generation 1 to 8.

/// Bytes of an entry in off-chip memory.
constexpr std::size_t packed_triangle_bytes(const Formats& formats) {
    return (std::size_t{stream_widths(formats).triangle} + 7) / 8;
}

/// Triangle::base follows the entry in bytes of its own. It is the model's tag, no hardware has it: not traffic.
constexpr std::size_t packed_triangle_tag_bytes = 4;

constexpr void store_word(std::uint32_t word, unsigned char* bytes) {
    for (int k = 0; k < 4; ++k)
        bytes[k] = static_cast<unsigned char>(word >> (8 * k) & 255);
}
constexpr std::uint32_t load_word(const unsigned char* bytes) {
    std::uint32_t word = 0;
    for (int k = 0; k < 4; ++k)
        word |= std::uint32_t{bytes[k]} << (8 * k);
    return word;
}

/// Appends fields to an entry in whole words; the last one may reach up to 4 bytes beyond the entry, into the tag.
/// Of a value that does not fit its field the lowest bits are kept, and `fits` tells.
class PackedFieldWriter {
  public:
    constexpr explicit PackedFieldWriter(unsigned char* bytes) : next_(bytes) {}

    constexpr void signed_number(std::int32_t value, int bits) {
        const auto code = static_cast<std::uint64_t>(std::int64_t{value});
        beyond_ |= (code + (std::uint64_t{1} << (bits - 1))) >> bits;
        append(code, bits);
    }
    constexpr void unsigned_number(std::uint32_t value, int bits) {
        beyond_ |= std::uint64_t{value} >> bits;
        append(value, bits);
    }
    constexpr void flag(bool value) { append(value ? 1 : 0, 1); }
    constexpr void sign(std::int8_t value) {
        beyond_ |= value == 1 || value == -1 ? 0 : 1;
        append(value < 0 ? 1 : 0, 1);
    }
    /// `bits` of the TestBits, the lowest of them at `place`.
    constexpr void test_bits(std::uint8_t value, int place, int bits) {
        const std::uint32_t code = std::uint32_t{value} >> place;
        beyond_ |= value ^ (code << place);
        unsigned_number(code, bits);
    }
    constexpr void split_by(std::uint8_t value, bool highlight_tag) {
        if (!highlight_tag) {
            test_bits(value, 0, 2);
            return;
        }
        test_bits(static_cast<std::uint8_t>(value & ~highlight_bit), 0, 2);
        flag((value & highlight_bit) != 0);
    }

    constexpr void finish() { store_word(static_cast<std::uint32_t>(waiting_), next_); }
    constexpr bool fits() const { return beyond_ == 0; }

  private:
    constexpr void append(std::uint64_t code, int bits) {
        waiting_ |= (code & ((std::uint64_t{1} << bits) - 1)) << count_;
        count_ += bits;
        if (count_ < 32)
            return;
        store_word(static_cast<std::uint32_t>(waiting_ & 0xffffffffU), next_);
        next_ += 4;
        waiting_ >>= 32;
        count_ -= 32;
    }

    unsigned char* next_;
    std::uint64_t waiting_ = 0;  // the `count_` bits not yet stored, fewer than 32 between fields
    int count_ = 0;
    std::uint64_t beyond_ = 0;  // not zero: a value did not fit
};

/// Takes the fields from an entry, in whole words as they were written.
class PackedFieldReader {
  public:
    constexpr explicit PackedFieldReader(const unsigned char* bytes) : next_(bytes) {}

    constexpr void signed_number(std::int32_t& value, int bits) {
        const std::uint64_t sign_bit = std::uint64_t{1} << (bits - 1);
        value = static_cast<std::int32_t>(static_cast<std::int64_t>((take(bits) ^ sign_bit) - sign_bit));
    }
    constexpr void unsigned_number(std::uint32_t& value, int bits) {
        value = static_cast<std::uint32_t>(take(bits));
    }
    constexpr void unsigned_number(std::uint8_t& value, int bits) {
        value = static_cast<std::uint8_t>(take(bits));
    }
    constexpr void flag(bool& value) { value = take(1) != 0; }
    constexpr void sign(std::int8_t& value) { value = take(1) != 0 ? std::int8_t{-1} : std::int8_t{1}; }
    constexpr void test_bits(std::uint8_t& value, int place, int bits) {
        value = static_cast<std::uint8_t>(take(bits) << place);
    }
    constexpr void split_by(std::uint8_t& value, bool highlight_tag) {
        test_bits(value, 0, 2);
        if (highlight_tag && take(1) != 0)
            value |= highlight_bit;
    }

  private:
    constexpr std::uint64_t take(int bits) {
        if (count_ < bits) {
            waiting_ |= std::uint64_t{load_word(next_)} << count_;
            next_ += 4;
            count_ += 32;
        }
        const std::uint64_t code = waiting_ & ((std::uint64_t{1} << bits) - 1);
        waiting_ >>= bits;
        count_ -= bits;
        return code;
    }

    const unsigned char* next_;
    std::uint64_t waiting_ = 0;  // the `count_` bits loaded and not yet taken
    int count_ = 0;
};

/// The layout: hands each field of a vertex to a writer or a reader, in order.
template <class Fields, class AnyVertex>
constexpr void visit_packed_vertex(Fields& fields, AnyVertex& vertex, const Formats& formats) {
    const auto vector = [&fields](auto& v, const Format& format) {
        fields.signed_number(v.x, format.bits);
        fields.signed_number(v.y, format.bits);
        fields.signed_number(v.z, format.bits);
    };
    vector(vertex.position, formats.position);
    vector(vertex.normal, formats.normal);
    vector(vertex.tangent, formats.normal);
    fields.sign(vertex.handedness);
    fields.unsigned_number(vertex.texture.u, formats.texture.bits);
    fields.unsigned_number(vertex.texture.v, formats.texture.bits);
    fields.unsigned_number(vertex.generation, formats.generation_bits);
    fields.flag(vertex.displaced_known);
    fields.flag(vertex.screen_normal_known);
    vector(vertex.displaced, formats.position);
    vector(vertex.displaced_normal, formats.normal);
    fields.signed_number(vertex.screen.x, formats.screen.bits);
    fields.signed_number(vertex.screen.y, formats.screen.bits);
    fields.signed_number(vertex.screen.w, formats.view_distance.bits);
    fields.flag(vertex.screen.in_front);
    vector(vertex.screen_normal, formats.normal);
}

/// The same for a triangle; its tag is no field.
template <class Fields, class AnyTriangle>
constexpr void visit_packed_triangle(Fields& fields, AnyTriangle& triangle, const Formats& formats) {
    for (auto& vertex : triangle.vertices)
        visit_packed_vertex(fields, vertex, formats);
    fields.split_by(triangle.split_by, formats.highlight_tag);
    fields.test_bits(triangle.stopped_by, 2, 3);
    fields.flag(triangle.finished);
}

/// Writes packed_triangle_bytes() and after them packed_triangle_tag_bytes. False: a value does not fit its field
/// and its highest bits are lost (a generation may, with the Generation Test switched off); the others are whole.
[[nodiscard]] constexpr bool pack_triangle(const Triangle& triangle, const Formats& formats,
                                           unsigned char* bytes) {
    PackedFieldWriter fields(bytes);
    visit_packed_triangle(fields, triangle, formats);
    fields.finish();
    store_word(triangle.base, bytes + packed_triangle_bytes(formats));
    return fields.fits();
}

/// Reads as many bytes as pack_triangle writes.
constexpr Triangle unpack_triangle(const unsigned char* bytes, const Formats& formats) {
    Triangle triangle;
    PackedFieldReader fields(bytes);
    visit_packed_triangle(fields, triangle, formats);
    triangle.base = load_word(bytes + packed_triangle_bytes(formats));
    return triangle;
}

}  // namespace tessera::datapath
