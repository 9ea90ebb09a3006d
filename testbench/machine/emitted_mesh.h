#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "modules/datapath/vertex.h"
#include "testbench/common/distinct_table.h"

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

/// Finished triangles in the order of their arrival, returned by value. Triangles that arrive one after another share
/// their equal corners: about 70 bytes per triangle, about 45 after sort().
class EmittedTriangles {
  public:
    using Corner = EmittedTriangle::Corner;

    EmittedTriangles() = default;
    EmittedTriangles(const std::vector<EmittedTriangle>& triangles) {
        for (const EmittedTriangle& triangle : triangles)
            push_back(triangle);
    }

    void push_back(const EmittedTriangle& t) {
        const auto& [a, b, c] = t.corners;
        stored_.push_back({{index_of(a), index_of(b), index_of(c)}, t.base, t.split_by, t.stopped_by, t.culled});
    }
    void clear() {
        corners_.clear();
        stored_.clear();
    }
    std::size_t size() const { return stored_.size(); }
    bool empty() const { return stored_.empty(); }
    EmittedTriangle operator[](std::size_t k) const {
        const Stored& s = stored_[k];
        return {{corners_[s.corners[0]], corners_[s.corners[1]], corners_[s.corners[2]]},
                s.base,
                s.split_by,
                s.stopped_by,
                s.culled};
    }

    /// The stored corners. After sort() each one once, in the order of their first use.
    const std::vector<Corner>& corners() const { return corners_; }
    /// Indices of the k-th triangle's corners. Equal corners may have different indices.
    const std::array<std::uint32_t, 3>& corner_indices(std::size_t k) const { return stored_[k].corners; }

    class Iterator {
      public:
        Iterator(const EmittedTriangles& triangles, std::size_t k) : triangles_(&triangles), k_(k) {}
        EmittedTriangle operator*() const { return (*triangles_)[k_]; }
        Iterator& operator++() {
            ++k_;
            return *this;
        }
        friend bool operator!=(const Iterator& a, const Iterator& b) { return a.k_ != b.k_; }

      private:
        const EmittedTriangles* triangles_;
        std::size_t k_;
    };
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size()}; }

    /// By base triangle, then texture coordinates, then displaced positions.
    void sort() {
        std::sort(stored_.begin(), stored_.end(), [this](const Stored& a, const Stored& b) {
            if (a.base != b.base)
                return a.base < b.base;
            for (std::size_t k = 0; k < 3; ++k) {
                const datapath::TexCoord &s = corners_[a.corners[k]].texture, &t = corners_[b.corners[k]].texture;
                if (!(s == t))
                    return std::tie(s.u, s.v) < std::tie(t.u, t.v);
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const datapath::Position &p = corners_[a.corners[k]].displaced, &q = corners_[b.corners[k]].displaced;
                if (!(p == q))
                    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
            }
            return false;
        });
        store_each_once();
    }

  private:
    struct Stored {
        std::array<std::uint32_t, 3> corners;
        std::uint32_t base;
        std::uint8_t split_by, stopped_by;
        bool culled;
    };

    /// The index of this corner, which is added if it is not the last one stored with the same hash.
    std::uint32_t index_of(const Corner& corner) {
        const std::uint64_t hash = mix_hash(0, std::uint64_t{corner.texture.u} << 32 | corner.texture.v);
        std::uint32_t& last = last_stored_[hash % last_stored_.size()];
        if (last >= corners_.size() || !(corners_[last] == corner)) {
            last = static_cast<std::uint32_t>(corners_.size());
            corners_.push_back(corner);
        }
        return last;
    }

    void store_each_once() {
        const std::vector<Corner> all = std::exchange(corners_, {});
        constexpr std::uint32_t unknown = UINT32_MAX;
        std::vector<std::uint32_t> new_index(all.size(), unknown);
        DistinctTable table;
        table.clear(all.size());
        for (Stored& triangle : stored_) {
            for (std::uint32_t& index : triangle.corners) {
                const Corner& corner = all[index];
                if (new_index[index] == unknown)
                    new_index[index] = table.number_of(
                        hash_of(corner), [&](std::uint32_t known) { return corners_[known] == corner; },
                        [&](std::uint32_t known) { return hash_of(corners_[known]); });
                index = new_index[index];
                if (index == corners_.size())
                    corners_.push_back(corner);
            }
        }
    }

    std::vector<Corner> corners_;
    std::vector<Stored> stored_;
    std::array<std::uint32_t, 1024> last_stored_{};  // by hash
};

/// All finished triangles of a run, including culled ones.
struct EmittedMesh {
    EmittedTriangles triangles;

    /// Whether a triangle was split with the Highlight Test true; otherwise files do not mention the test.
    bool has_highlight_splits() const {
        for (const EmittedTriangle& triangle : triangles)
            if ((triangle.split_by & datapath::highlight_bit) != 0)
                return true;
        return false;
    }

    /// So that runs that emit the same triangles in any order write identical files.
    void sort() { triangles.sort(); }
};

}  // namespace tessera
