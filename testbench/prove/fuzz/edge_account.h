#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "modules/datapath/vertex.h"

namespace tessera::fuzz {

/// The directed edges of triangles, those that run in opposite directions between the same two vertices taken against
/// each other. Vertices are the same if all the machine knows of them is, bit for bit; so what is left of a
/// mesh are its borders and, where two sides of an edge were split differently or to different places, its
/// cracks.
class EdgeAccount {
  public:
    void add(const datapath::Triangle& triangle);
    void add(const datapath::Vertex& from, const datapath::Vertex& to);

    /// The same with the direction turned: takes one away.
    void remove(const datapath::Vertex& from, const datapath::Vertex& to) { add(to, from); }

    /// Whether every edge is taken up by another.
    bool balanced() const;

    /// How many different vertices there were.
    std::size_t vertices() const { return numbers_.size(); }

  private:
    using VertexKey = std::array<std::int32_t, 22>;
    std::uint32_t number_of(const datapath::Vertex& vertex);

    std::map<VertexKey, std::uint32_t> numbers_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> edges_;  // the lower number first
};

}  // namespace tessera::fuzz
