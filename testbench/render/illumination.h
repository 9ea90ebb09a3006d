#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/render/ray_scene.h"
#include "testbench/render/style.h"
#include "testbench/render/view.h"

namespace tessera {

/// The intersection of a ray with the mesh, seen from the viewer's side. Positions are relative to the mesh's origin.
struct ShadingPoint {
    std::uint32_t triangle = 0;
    /// Origin of rays to the lights: outside the flat triangle, on the curved surface implied by its normals, so that a
    /// coarse triangle does not shadow itself.
    glm::vec3 ray_origin{0};
    glm::dvec3 normal{0};  ///< unit, interpolated from N', on the viewer's side
};

/// Sub-pixel samples; each uses its own subset of the lights, all of them together use all.
inline constexpr std::size_t samples_per_pixel = 8;

/// The light at a point, linear: about 1 for a white surface facing full light.
struct Light {
    glm::dvec3 diffuse{0};
    double highlight = 0;
};

/// A key light with a soft edge, a weak fill light without shadow, and a sky that is brightest overhead. The directions
/// are fixed and the same at every pixel: there is no noise, and order does not matter.
class Illumination {
  public:
    Illumination(const View& view, const Style& style, const RayScene& scene);

    /// Reusable memory for light(), one per thread.
    struct Scratch {
        std::vector<glm::vec3> origins;
        std::vector<std::size_t> facing;  // points on the lamp's side
        std::vector<std::uint8_t> occluded;
    };

    /// A part of the surface: points that share a sub-pixel position; fast if they are neighbours.
    struct Patch {
        const std::vector<ShadingPoint>& points;
        /// The points cover the patch without gaps. If all or none of the first quarter of the points see a direction,
        /// the others are then treated alike, provided that the patch is nearly flat.
        bool whole;
    };

    void light(std::size_t sample, const Patch& patch, std::vector<Light>& lights, Scratch& scratch) const;

  private:
    struct Lamp {
        glm::dvec3 direction;   ///< towards the lamp
        glm::dvec3 diffuse{0};  ///< multiplied by the cosine
        double highlight = 0;
        glm::dvec3 half{0};  ///< half vector between lamp and viewer
    };

    void trace(const Lamp& lamp, const std::vector<ShadingPoint>& points, std::size_t first, std::size_t end,
               Scratch& scratch) const;
    void add(const Lamp& lamp, const std::vector<ShadingPoint>& points, bool flat, glm::dmat3& even,
             std::vector<Light>& lights, Scratch& scratch) const;

    const RayScene& scene_;
    glm::dvec3 eye_;  ///< direction towards the viewer, accurate enough for highlights
    glm::dvec3 fill_;
    std::vector<Lamp> lamps_[samples_per_pixel];
};

}  // namespace tessera
