#include "testbench/prove/fuzz/edge_account.h"

#include <algorithm>

namespace tessera::fuzz {

std::uint32_t EdgeAccount::number_of(const datapath::Vertex& v) {
    const VertexKey key{v.position.x,
                        v.position.y,
                        v.position.z,
                        v.normal.x,
                        v.normal.y,
                        v.normal.z,
                        v.tangent.x,
                        v.tangent.y,
                        v.tangent.z,
                        static_cast<std::int32_t>(v.texture.u),
                        static_cast<std::int32_t>(v.texture.v),
                        v.handedness,
                        v.generation,
                        v.displaced.x,
                        v.displaced.y,
                        v.displaced.z,
                        v.displaced_normal.x,
                        v.displaced_normal.y,
                        v.displaced_normal.z,
                        v.screen.x,
                        v.screen.y,
                        v.screen.w};
    return numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
}

void EdgeAccount::add(const datapath::Vertex& from, const datapath::Vertex& to) {
    const std::uint32_t a = number_of(from), b = number_of(to);
    if (a != b)
        edges_[std::minmax(a, b)] += a < b ? 1 : -1;
}

void EdgeAccount::add(const datapath::Triangle& triangle) {
    for (std::size_t k = 0; k < 3; ++k)
        add(triangle.vertices[k], triangle.vertices[(k + 1) % 3]);
}

bool EdgeAccount::balanced() const {
    return std::all_of(edges_.begin(), edges_.end(), [](const auto& edge) { return edge.second == 0; });
}

}  // namespace tessera::fuzz
