#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modules/datapath/midpoint.h"
#include "modules/datapath/vertex.h"
#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// A corner of an emitted triangle: 3 * its index + 0, 1 or 2.
using CornerRef = std::uint32_t;
inline constexpr CornerRef no_corner = UINT32_MAX;

inline const EmittedTriangle::Corner& corner_of(const EmittedMesh& mesh, CornerRef ref) {
    return mesh.triangles[ref / 3].corners[ref % 3];
}
/// The corner that follows in its triangle.
inline CornerRef next_corner(CornerRef ref) {
    return ref % 3 == 2 ? ref - 2 : ref + 1;
}

/// What a vertex of a patch is known by.
struct SurfacePoint {
    datapath::Position position;  ///< P
    datapath::TexCoord texture;   ///< t
    friend bool operator==(const SurfacePoint& a, const SurfacePoint& b) {
        return a.position == b.position && a.texture == b.texture;
    }
};

template <class HasPositionAndTexture>
SurfacePoint surface_point(const HasPositionAndTexture& vertex) {
    return {vertex.position, vertex.texture};
}
inline SurfacePoint midpoint(const SurfacePoint& a, const SurfacePoint& b) {
    return {datapath::midpoint(a.position, b.position), datapath::midpoint(a.texture, b.texture)};
}

/// One word into a hash; the same on every machine.
constexpr std::uint64_t hash_word(std::uint64_t hash, std::uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 29);
}
constexpr std::uint64_t hash_pair(std::uint64_t hash, std::int32_t high, std::int32_t low) {
    return hash_word(hash,
                     std::uint64_t{static_cast<std::uint32_t>(high)} << 32 | static_cast<std::uint32_t>(low));
}

/// Numbers the vertices of one patch after another, in the order they come in. Keeps its memory from patch to
/// patch.
class CornerTable {
  public:
    static constexpr std::uint32_t none = UINT32_MAX;

    explicit CornerTable(const EmittedMesh& mesh) : mesh_(mesh) {}

    /// Forgets all, and makes room for the vertices of `corners` corners.
    void start(std::size_t corners) {
        std::size_t slots = 16;
        while (slots < corners + corners / 4)
            slots *= 2;
        slots_.assign(slots, none);
        first_corners_.clear();
    }
    std::uint32_t insert(CornerRef ref) {
        std::uint32_t& slot = slot_of(surface_point(corner_of(mesh_, ref)));
        if (slot == none) {
            slot = static_cast<std::uint32_t>(first_corners_.size());
            first_corners_.push_back(ref);
        }
        return slot;
    }
    /// The vertex's number, or none.
    std::uint32_t find(const SurfacePoint& point) { return slot_of(point); }
    /// The first corner inserted of a vertex.
    CornerRef first_corner(std::uint32_t id) const { return first_corners_[id]; }
    std::size_t size() const { return first_corners_.size(); }

  private:
    std::uint32_t& slot_of(const SurfacePoint& point) {
        std::uint64_t hash = hash_pair(0, point.position.x, point.position.y);
        hash = hash_word(hash, static_cast<std::uint32_t>(point.position.z));
        hash = hash_word(hash, std::uint64_t{point.texture.u} << 32 | point.texture.v);
        std::size_t slot = static_cast<std::size_t>(hash_word(hash, 0) >> 8) & (slots_.size() - 1);
        while (slots_[slot] != none &&
               !(surface_point(corner_of(mesh_, first_corners_[slots_[slot]])) == point))
            slot = (slot + 1) & (slots_.size() - 1);
        return slots_[slot];
    }

    const EmittedMesh& mesh_;
    std::vector<std::uint32_t> slots_;
    std::vector<CornerRef> first_corners_;
};

}  // namespace tessera
