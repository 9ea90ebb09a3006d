#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "modules/datapath/vertex.h"
#include "testbench/common/hash.h"

namespace tessera {

/// A finished triangle, in the hardware's formats.
struct EmittedTriangle {
    struct Corner {
        datapath::Position position;           ///< P
        datapath::Position displaced;          ///< P'
        datapath::Direction displaced_normal;  ///< N'
        datapath::TexCoord texture;            ///< t
        std::uint8_t generation = 0;
        friend bool operator==(const Corner& a, const Corner& b) {
            return a.position == b.position && a.displaced == b.displaced && a.displaced_normal == b.displaced_normal &&
                   a.texture == b.texture && a.generation == b.generation;
        }
    };
    std::array<Corner, 3> corners;
    std::uint32_t base = 0;
    std::uint8_t split_by = 0;    ///< NT, SHT, HT bits of the parent's split; 0: a base triangle
    std::uint8_t stopped_by = 0;  ///< VT, TCT, GT bits
    bool culled = false;          ///< faces away and was not sent to Lighting

    static EmittedTriangle from(const datapath::Triangle& triangle, bool culled) {
        EmittedTriangle result;
        for (std::size_t k = 0; k < 3; ++k) {
            const datapath::Vertex& v = triangle.vertices[k];
            result.corners[k] = {v.position, v.displaced, v.displaced_normal, v.texture, v.generation};
        }
        result.base = triangle.base;
        result.split_by = triangle.split_by;
        result.stopped_by = triangle.stopped_by;
        result.culled = culled;
        return result;
    }
    friend bool operator==(const EmittedTriangle& a, const EmittedTriangle& b) {
        return a.corners == b.corners && a.base == b.base && a.split_by == b.split_by && a.stopped_by == b.stopped_by &&
               a.culled == b.culled;
    }
};

/// Of P, P', N' and t.
inline std::uint64_t hash_of(const EmittedTriangle::Corner& c) {
    const datapath::Position &p = c.position, &displaced = c.displaced;
    const datapath::Direction& n = c.displaced_normal;
    std::uint64_t hash = 0;
    for (const std::uint64_t word :
         {hash_word(p.x, p.y), hash_word(p.z, displaced.x), hash_word(displaced.y, displaced.z), hash_word(n.x, n.y),
          hash_word(0, n.z), std::uint64_t{c.texture.u} << 32 | c.texture.v})
        hash = mix_hash(hash, word);
    return hash;
}

/// All finished triangles of a run, including culled ones.
struct EmittedMesh {
    std::vector<EmittedTriangle> triangles;

    /// Whether a triangle was split with the Highlight Test true; otherwise files do not mention the test.
    bool has_highlight_splits() const {
        return std::any_of(triangles.begin(), triangles.end(), [](const EmittedTriangle& triangle) {
            return (triangle.split_by & datapath::highlight_bit) != 0;
        });
    }

    /// Sorts by base triangle, then texture coordinates, then displaced positions, so that runs that emit the same
    /// triangles in any order write identical files.
    void sort() {
        const auto key = [](const EmittedTriangle& t) {
            const auto& c = t.corners;
            return std::make_tuple(t.base, c[0].texture.u, c[0].texture.v, c[1].texture.u, c[1].texture.v,
                                   c[2].texture.u, c[2].texture.v, c[0].displaced.x, c[0].displaced.y, c[0].displaced.z,
                                   c[1].displaced.x, c[1].displaced.y, c[1].displaced.z, c[2].displaced.x,
                                   c[2].displaced.y, c[2].displaced.z);
        };
        std::sort(triangles.begin(), triangles.end(),
                  [&](const EmittedTriangle& a, const EmittedTriangle& b) { return key(a) < key(b); });
    }
};

}  // namespace tessera
