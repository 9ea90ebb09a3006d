#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "modules/datapath/vertex.h"

namespace tessera::fuzz {

/// Counts the directed edges of triangles; edges of opposite direction between the same two vertices cancel. Vertices
/// are the same if all their fields are bit-identical. The remaining edges of a mesh are its borders and its cracks,
/// where two sides of an edge were split differently or at different positions.
class EdgeAccount {
  public:
    void add(const datapath::Triangle& triangle);
    void add(const datapath::Vertex& from, const datapath::Vertex& to);

    /// Adds the reversed edge, which cancels this one.
    void remove(const datapath::Vertex& from, const datapath::Vertex& to) { add(to, from); }

    /// Whether all edges cancel.
    bool balanced() const;

  private:
    using VertexKey = std::array<std::int32_t, 22>;
    std::uint32_t number_of(const datapath::Vertex& vertex);

    std::map<VertexKey, std::uint32_t> numbers_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> edges_;  // the lower number first
};

}  // namespace tessera::fuzz
