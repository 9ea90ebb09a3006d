#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "testbench/render/render_mesh.h"

// Embree's device and scene.
struct RTCDeviceTy;
struct RTCSceneTy;

namespace tessera {

/// Relative to the mesh's origin, not to 0.
struct Ray {
    glm::dvec3 origin, direction;
    double near = 0;  ///< in lengths of direction
};

/// The mesh prepared for ray queries. Thread-safe; a result depends only on the mesh and the batch. Embree's single
/// precision only finds the triangle: the caller computes the point.
class RayScene {
  public:
    static constexpr std::uint32_t nothing = UINT32_MAX;

    /// `mesh` must outlive the scene. Throws ResourceError when memory runs out.
    explicit RayScene(const RenderMesh& mesh);

    /// Finds each ray's first triangle, or nothing. Fast if neighbours in the batch are neighbours in space.
    void first_hits(const std::vector<Ray>& rays, std::vector<std::uint32_t>& triangles) const;

    /// Appends 1 for each origin from which a triangle blocks the direction, else 0.
    void occlusions(const std::vector<glm::vec3>& origins, const glm::dvec3& direction,
                    std::vector<std::uint8_t>& occluded) const;

  private:
    std::shared_ptr<RTCDeviceTy> device_;
    std::shared_ptr<RTCSceneTy> scene_;
};

}  // namespace tessera
