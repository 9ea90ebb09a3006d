#pragma once
#include <cstddef>
#include <cstdint>

#include "modules/datapath/pack_triangle.h"
#include "modules/datapath/preconditions.h"
#include "modules/datapath/vertex.h"
#include "modules/sockets/items.h"

// Records in bus memory: 32-bit words, little endian, the same for all formats. A signed value is sign-extended to the
// whole word. Each list below is the layout: packing, the C header and the documentation are derived from it.
// (Decision: not packed like queue entries, so that a C program declares a record as a struct. A base triangle takes
// 144 bytes instead of 92, but is read once per frame.)

namespace tessera {

/// The words of a base triangle's vertex: calls word(name, value, is signed, meaning) for each.
template <class AnyVertex, class Word>
constexpr void describe_base_vertex(AnyVertex& v, Word&& word) {
    word("px", v.position.x, true, "P, position's format");
    word("py", v.position.y, true, "");
    word("pz", v.position.z, true, "");
    word("nx", v.normal.x, true, "N, normal's format; no component beyond 1.0 in magnitude");
    word("ny", v.normal.y, true, "");
    word("nz", v.normal.z, true, "");
    word("tx", v.tangent.x, true, "T, same format and limit as N");
    word("ty", v.tangent.y, true, "");
    word("tz", v.tangent.z, true, "");
    word("handedness", v.handedness, true, "1 or -1: bitangent = handedness (N x T)");
    word("u", v.texture.u, false, "t in texels, texture's format: at most 2^integer");
    word("v", v.texture.v, false, "");
}

/// The words of a finished triangle's vertex.
template <class AnyCorner, class Word>
constexpr void describe_finished_vertex(AnyCorner& c, Word&& word) {
    word("x", c.screen.x, true, "P's in pixels, screen's format");
    word("y", c.screen.y, true, "");
    word("w", c.screen.w, true, "distance from the eye, in the view distance's format");
    word("u", c.texture.u, false, "t in texels, texture's format");
    word("v", c.texture.v, false, "");
    std::uint32_t light = c.intensity | (c.screen.in_front ? 256u : 0u);
    word("light", light, false, "bits 7 to 0: intensity; bit 8: in front of the near plane");
    if constexpr (!std::is_const_v<AnyCorner>) {
        c.intensity = static_cast<std::uint8_t>(light & 255);
        c.screen.in_front = (light & 256) != 0;
    }
}

inline constexpr std::uint32_t base_triangle_bytes = 3 * 12 * 4;
inline constexpr std::uint32_t finished_triangle_bytes = 3 * 6 * 4;

/// Writes the words of a triangle's vertices, one after another.
class RecordWriter {
  public:
    explicit constexpr RecordWriter(unsigned char* bytes) : next_(bytes) {}
    template <class Value>
    constexpr void operator()(const char*, const Value& value, bool, const char*) {
        datapath::store_word(static_cast<std::uint32_t>(static_cast<std::int64_t>(value)), next_);
        next_ += 4;
    }

  private:
    unsigned char* next_;
};

/// Reads the words. A value that does not fit its member is made to fit; `fits` is then false.
class RecordReader {
  public:
    explicit constexpr RecordReader(const unsigned char* bytes) : next_(bytes) {}
    template <class Value>
    constexpr void operator()(const char*, Value& value, bool, const char*) {
        const std::uint32_t word = datapath::load_word(next_);
        value = static_cast<Value>(word);
        fits_ = fits_ && static_cast<std::uint32_t>(static_cast<std::int64_t>(value)) == word;
        next_ += 4;
    }
    constexpr bool fits() const { return fits_; }

  private:
    const unsigned char* next_;
    bool fits_ = true;
};

constexpr void write_base_triangle(const datapath::Triangle& triangle, unsigned char* bytes) {
    RecordWriter writer(bytes);
    for (const datapath::Vertex& vertex : triangle.vertices)
        describe_base_vertex(vertex, writer);
}

/// Returns false if a value is beyond its format.
[[nodiscard]] constexpr bool read_base_triangle(const unsigned char* bytes, const datapath::Formats& formats,
                                                datapath::Triangle& triangle) {
    RecordReader reader(bytes);
    bool all_fit = true;
    for (datapath::Vertex& vertex : triangle.vertices) {
        describe_base_vertex(vertex, reader);
        all_fit = all_fit && datapath::fits_formats(vertex, formats);
    }
    return all_fit && reader.fits();
}

constexpr void write_finished_triangle(const LitTriangle& triangle, unsigned char* bytes) {
    RecordWriter writer(bytes);
    for (const LitTriangle::Corner& corner : triangle.corners)
        describe_finished_vertex(corner, writer);
}

constexpr LitTriangle read_finished_triangle(const unsigned char* bytes) {
    LitTriangle triangle;
    RecordReader reader(bytes);
    for (LitTriangle::Corner& corner : triangle.corners)
        describe_finished_vertex(corner, reader);
    return triangle;
}

}  // namespace tessera
