#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>

#include "testbench/machine/emitted_mesh.h"

namespace tessera::testing {

/// All values of a triangle that must not depend on the machine's timing.
using Key = std::array<std::int64_t, 37>;

inline std::multiset<Key> keys(const EmittedMesh& mesh) {
    std::multiset<Key> result;
    for (const EmittedTriangle& triangle : mesh.triangles) {
        Key key{};
        std::size_t place = 0;
        for (const auto& c : triangle.corners)
            for (const std::int64_t value :
                 {std::int64_t{c.texture.u}, std::int64_t{c.texture.v}, std::int64_t{c.displaced.x},
                  std::int64_t{c.displaced.y}, std::int64_t{c.displaced.z}, std::int64_t{c.displaced_normal.x},
                  std::int64_t{c.displaced_normal.y}, std::int64_t{c.displaced_normal.z}, std::int64_t{c.position.x},
                  std::int64_t{c.position.y}, std::int64_t{c.generation}})
                key[place++] = value;
        key[place++] = triangle.base;
        key[place++] = triangle.split_by;
        key[place++] = triangle.stopped_by;
        key[place] = triangle.culled;
        result.insert(key);
    }
    return result;
}

}  // namespace tessera::testing
