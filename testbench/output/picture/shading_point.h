#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace tessera {

/// Where a ray met the mesh, seen from the viewer's side. Positions count from the mesh's origin.
struct ShadingPoint {
    std::uint32_t triangle = 0;
    /// Where rays to the lights begin: outside the flat triangle, on the round surface its normals stand for,
    /// so that a coarse triangle does not shadow itself.
    glm::vec3 ray_origin{0};
    glm::dvec3 normal{0};  ///< unit, interpolated from N', on the viewer's side
};

}  // namespace tessera
