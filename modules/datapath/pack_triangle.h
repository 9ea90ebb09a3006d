#pragma once
#include <cstddef>
#include <cstdint>

#include "modules/datapath/fields.h"
#include "modules/datapath/vertex.h"

namespace tessera::datapath {

/// A Triangle Queue entry, packed for off-chip memory as the hardware would write it, so that every spilling run tests
/// packing and unpacking.
///
/// Layout: the fields of describe_triangle(), the lowest bit first, little endian, without gaps, each as wide as its
/// format, in all packed_triangle_bits(). Signed fields are two's complement. Unused bits of the last byte are zero.

/// Bits of an entry.
constexpr std::uint32_t packed_triangle_bits(const Formats& formats) {
    WidthCounter counter;
    Fields<WidthCounter> fields(counter, formats);
    const Triangle triangle;
    describe_triangle(fields, triangle);
    return counter.bits;
}

/// Bytes of an entry in off-chip memory.
constexpr std::size_t packed_triangle_bytes(const Formats& formats) {
    return (std::size_t{packed_triangle_bits(formats)} + 7) / 8;
}

/// Triangle::base and parent follow the entry in bytes of their own. They are tags of the model only and not counted as
/// traffic.
constexpr std::size_t packed_triangle_tag_bytes = 8;

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

/// Appends fields to an entry in whole words; the last word may reach up to 4 bytes beyond the entry, into the tag.
/// A value that does not fit its field is truncated to its lowest bits, and `fits` is then false. A codec of fields.h.
class FieldWriter {
  public:
    constexpr explicit FieldWriter(unsigned char* bytes) : next_(bytes) {}

    constexpr std::int64_t field(const Field& field, std::int64_t value) {
        const auto code = static_cast<std::uint64_t>(value);
        beyond_ |= (field.is_signed ? code + (std::uint64_t{1} << (field.bits - 1)) : code) >> field.bits;
        append(code, field.bits);
        return value;
    }
    constexpr std::uint32_t annotation(const char*, std::uint32_t value) const { return value; }

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
    std::uint64_t beyond_ = 0;  // not zero if a value did not fit
};

/// Reads the fields of an entry, in whole words as FieldWriter writes them. A codec of fields.h.
class FieldReader {
  public:
    constexpr explicit FieldReader(const unsigned char* bytes) : next_(bytes) {}

    constexpr std::int64_t field(const Field& field, std::int64_t) {
        const std::uint64_t code = take(field.bits);
        if (!field.is_signed)
            return static_cast<std::int64_t>(code);
        const std::uint64_t sign_bit = std::uint64_t{1} << (field.bits - 1);
        return static_cast<std::int64_t>((code ^ sign_bit) - sign_bit);
    }
    constexpr std::uint32_t annotation(const char*, std::uint32_t value) const { return value; }

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
    std::uint64_t waiting_ = 0;  // the `count_` bits loaded and not yet used
    int count_ = 0;
};

/// Writes packed_triangle_bytes() and then packed_triangle_tag_bytes. Returns false if a value does not fit its field
/// and loses its highest bits (possible for a generation with the Generation Test off); the others are correct.
[[nodiscard]] constexpr bool pack_triangle(const Triangle& triangle, const Formats& formats, unsigned char* bytes) {
    FieldWriter writer(bytes);
    Fields<FieldWriter> fields(writer, formats);
    describe_triangle(fields, triangle);
    writer.finish();
    unsigned char* const tag = bytes + packed_triangle_bytes(formats);
    store_word(triangle.base, tag);
    store_word(triangle.parent, tag + 4);
    return writer.fits();
}

/// Reads as many bytes as pack_triangle writes.
constexpr Triangle unpack_triangle(const unsigned char* bytes, const Formats& formats) {
    Triangle triangle;
    FieldReader reader(bytes);
    Fields<FieldReader> fields(reader, formats);
    describe_triangle(fields, triangle);
    const unsigned char* const tag = bytes + packed_triangle_bytes(formats);
    triangle.base = load_word(tag);
    triangle.parent = load_word(tag + 4);
    return triangle;
}

}  // namespace tessera::datapath
