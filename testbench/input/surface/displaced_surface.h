#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "testbench/input/map/map_displacement.h"
#include "testbench/input/mesh/base_mesh.h"
#include "testbench/job/job.h"

namespace tessera {

/// How the map is read between its samples.
///
/// `interpolated`: bilinear between texel centres. The headline. A map is samples of a surface, and this is
/// the simplest surface through them that is continuous: a mesh of enough triangles can come as near to it as
/// it likes, so an error against it measures the tessellation. It includes what the hardware's own reading
/// costs: up to half a texel sideways.
///
/// `nearest_texel`: as the hardware reads it, the texel that holds t (golden/ALGORITHM.md 2: the last border
/// reads the last texel, or the first where the map repeats). That surface is a staircase with a step at
/// every texel's edge: no mesh without cracks follows it, and an error against it does not fall below half of
/// the map's steps. Reported beside the headline because it tells the two causes apart: small against this
/// and large against the other is addressing.
enum class Sampling : std::uint8_t { interpolated, nearest_texel };

/// What turns map values into displacement, and how the map goes on beyond its borders.
struct DisplacementOf {
    double scale = 1, bias = 0;  // of MapDisplacement
    Addressing address_u = Addressing::clamp, address_v = Addressing::clamp;

    static DisplacementOf from(const Job& job, const HeightMap& map) {
        const MapDisplacement displacement = MapDisplacement::from(job.displacement, map);
        return {displacement.scale, displacement.bias, job.map.address_u, job.map.address_v};
    }
    double of(double value) const { return bias + scale * value; }
};

/// Space as it is measured in: the models near 0 and of a size near 1, whatever theirs. The scale is a power of two and
/// so costs no precision.
struct LocalFrame {
    glm::dvec3 centre{0};
    double scale = 1;  ///< local = (model - centre) * scale

    glm::dvec3 to_local(const glm::dvec3& model) const { return (model - centre) * scale; }
    glm::dvec3 to_model(const glm::dvec3& local) const { return local / scale + centre; }
};

/// The surface the hardware approximates (golden/ALGORITHM.md 1), in double precision and from the map's own values,
/// not their codes: what rounding to the hardware's formats costs is part of the error. At barycentric coordinates b of
/// a base triangle
///
///     p' = sum b P + (bias + scale * value(t)) * normalise(sum b N)        t = sum b t_k
///
/// Texture coordinates outside the map on an axis that clamps are first set to its border at the vertices, as the host
/// does. Mesh and map must outlive this. Positions are local (LocalFrame).
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

    glm::dvec3 point(const Corners& corners, const glm::dvec3& b, Sampling sampling) const;
    static glm::dvec2 texel(const Corners& corners, const glm::dvec3& b) {
        return b.x * corners.texel[0] + b.y * corners.texel[1] + b.z * corners.texel[2];
    }
    /// 0..1 spans the map.
    glm::dvec2 texture(const glm::dvec2& texel) const { return texel / glm::dvec2(map_.width, map_.height); }

    /// The map's value at t in texels.
    double value(const glm::dvec2& texel, Sampling sampling) const;

  private:
    const BaseMesh& mesh_;
    const HeightMap& map_;
    DisplacementOf displacement_;
    LocalFrame frame_;
};

/// The texel an index outside the map stands for.
std::int64_t addressed(std::int64_t index, std::int64_t size, Addressing mode);

/// A base vertex's texture coordinate in texels, set to the border where it lies outside an axis that clamps.
glm::dvec2 texel_of(const BaseVertex& vertex, const HeightMap& map, const DisplacementOf& displacement);

/// A texel's mean model-space length: |dp/du| / width and |dp/dv| / height, area-weighted means over the base surface
/// (BaseMesh::texture_scale), and the mean of the two. The unit that errors "in texels" are given in.
double texel_length(const BaseMesh& mesh, const HeightMap& map);

}  // namespace tessera
