#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/job/job.h"
#include "testbench/setup/map_displacement.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// How the map is sampled between texel centres.
///
/// `interpolated`: bilinear between texel centres. The main figure. It is the simplest continuous surface through
/// the map's samples, and a mesh of enough triangles approximates it to any accuracy, so an error against it
/// measures the tessellation. It includes the effect of the hardware's sampling: up to half a texel sideways.
///
/// `nearest_texel`: like the hardware, the texel that contains t (golden/ALGORITHM.md 2: the last border reads the
/// last texel, or the first if the map repeats). That surface has a step at every texel's edge. No mesh without
/// cracks follows it, and an error against it stays above half of the map's steps. Reported in addition to separate
/// the two causes: an error that is small against this and large against the other is due to addressing.
/// Distances are to and from the surface with its limits: a texel is flat up to and including all its edges, and a step
/// is a wall between the heights on its two sides.
enum class Sampling : std::uint8_t { interpolated, nearest_texel };

/// On a texel's edge along an axis: the texel below it, not the one above, which the hardware reads. To be combined.
enum Below : std::uint8_t { below_u = 1, below_v = 2 };
constexpr std::uint8_t axes(bool u, bool v) {
    return static_cast<std::uint8_t>((u ? +below_u : 0) | (v ? +below_v : 0));
}

/// Conversion of map values to displacement, and the map's address modes.
struct DisplacementOf {
    double scale = 1, bias = 0;  // of MapDisplacement
    Addressing address_u = Addressing::clamp, address_v = Addressing::clamp;

    static DisplacementOf from(const Job& job, const HeightMap& map) {
        const MapDisplacement displacement = MapDisplacement::from(job.displacement, map);
        return {displacement.scale, displacement.bias, job.map.address_u, job.map.address_v};
    }
    double of(double value) const { return bias + scale * value; }
};

/// Local coordinates for measurement: the model is centred near 0 and has a size near 1. The scale is a power of two,
/// so no precision is lost.
struct LocalFrame {
    glm::dvec3 centre{0};
    double scale = 1;  ///< local = (model - centre) * scale

    glm::dvec3 to_local(const glm::dvec3& model) const { return (model - centre) * scale; }
    glm::dvec3 to_model(const glm::dvec3& local) const { return local / scale + centre; }
};

/// The surface that the hardware approximates (golden/ALGORITHM.md 1), in double precision and from the map's own
/// values, not their codes, so that rounding to the hardware's formats is part of the error. At barycentric coordinates
/// b of a base triangle
///
///     p' = sum b P + (bias + scale * value(t)) * normalise(sum b N)        t = sum b t_k
///
/// Vertices' texture coordinates outside the map on a clamped axis are first set to its border, as the host does. Mesh
/// and map must outlive this. Positions are local (LocalFrame).
class DisplacedSurface {
  public:
    DisplacedSurface(const BaseMesh& mesh, const HeightMap& map, const DisplacementOf& displacement,
                     const LocalFrame& frame);

    std::size_t triangles() const { return mesh_.triangles.size(); }
    const LocalFrame& frame() const { return frame_; }

    struct Corners {
        std::array<glm::dvec3, 3> position, normal;
        std::array<glm::dvec2, 3> texel;  ///< t in texels
        bool flat = false;                ///< all three normals are the same
    };
    Corners corners(std::size_t triangle) const;

    glm::dvec3 point(const Corners& corners, const glm::dvec3& b, Sampling sampling, unsigned below = 0) const;
    static glm::dvec2 texel(const Corners& corners, const glm::dvec3& b) {
        return b.x * corners.texel[0] + b.y * corners.texel[1] + b.z * corners.texel[2];
    }
    /// The texture coordinate; 0..1 spans the map.
    glm::dvec2 texture(const glm::dvec2& texel) const { return texel / glm::dvec2(map_.width, map_.height); }

    /// The map's value at t in texels. `below`: of Below, for nearest_texel.
    double value(const glm::dvec2& texel, Sampling sampling, unsigned below = 0) const;
    /// The axes, as Below, on whose texel's edge t lies, with different values of nearest_texel on its two sides.
    std::uint8_t steps_at(const glm::dvec2& texel) const;

  private:
    const BaseMesh& mesh_;
    const HeightMap& map_;
    DisplacementOf displacement_;
    LocalFrame frame_;
};

/// Applies the address mode to a texel index.
std::int64_t addressed(std::int64_t index, std::int64_t size, Addressing mode);

/// A base vertex's texture coordinate in texels, set to the border if it lies outside a clamped axis.
glm::dvec2 texel_of(const BaseVertex& vertex, const BaseMesh& mesh, const HeightMap& map,
                    const DisplacementOf& displacement);

/// A texel's mean length in model units, the unit of errors "in texels": the mean of |dp/du| / width and |dp/dv| /
/// height, each an area-weighted mean over the base surface (BaseMesh::texture_scale).
double texel_length(const BaseMesh& mesh, const HeightMap& map);

}  // namespace tessera
