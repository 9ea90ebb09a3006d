#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "testbench/bake/displaced_surface.h"
#include "testbench/compare/error_view.h"
#include "testbench/run_folder/recorded_mesh.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// A base mesh whose displaced surface is a height over a plane: all vertices lie in one plane, all normals are the
/// plane's (both to 1e-6), and texture coordinates are an invertible affine function of position (to a thousandth of a
/// texel).
struct HeightField {
    glm::dvec3 origin{0}, normal{0};  ///< the plane's, model units
    glm::dvec3 u{0}, v{0};            ///< texel coordinate = texel_origin + (dot(u, p - origin), dot(v, p - origin))
    glm::dvec2 texel_origin{0};

    glm::dvec2 texel(const glm::dvec3& p) const {
        return texel_origin + glm::dvec2(glm::dot(u, p - origin), glm::dot(v, p - origin));
    }
    double height(const glm::dvec3& p) const { return glm::dot(normal, p - origin); }
};

/// Nothing if the mesh is not a height field; `why` then gives the reason in a few words.
std::optional<HeightField> find_height_field(const BaseMesh& base, const HeightMap& map,
                                             const DisplacementOf& displacement, std::string& why);

/// The error measure of terrain simplification: at every grid point of the map (a texel's centre), the difference
/// between the mesh's height over the plane and the map's value. Both sampling methods agree at texel centres. A grid
/// point under several triangles (a shared edge, a fold) counts with its largest error; one that rounding has left just
/// beside the mesh's border, with the mesh's nearest height. On a repeated axis every copy
/// of the map on the base mesh counts.
struct VerticalError {
    std::uint64_t grid_points = 0;          ///< texel centres on the base mesh
    std::uint64_t covered = 0;              ///< grid points under the emitted mesh; only these count below
    double max = 0, rms = 0;                ///< model units; all grid points have equal weight
    std::uint64_t seen = 0;                 ///< covered grid points in the picture, hidden ones too; 0 without a view
    double max_pixels = 0, rms_pixels = 0;  ///< distance in the picture to the mesh above or below
    double map_unit = 0;                    ///< one unit of the map's source in model units; 0 if the scale is 0
    glm::dvec2 worst_texel{0};              ///< the grid point with the maximum, in texels
    glm::dvec3 worst_position{0};           ///< on the displaced surface, model units
    std::uint64_t worst_triangle = 0;       ///< the emitted triangle over it
};

/// Evaluated in bands of rows of at most 2^22 grid points; takes 40 MB for any map size. ResourceError beyond 2^32 grid
/// points. `view`: the camera, to measure errors in the picture too; may be null.
VerticalError measure_vertical_error(const HeightField& field, const BaseMesh& base, const HeightMap& map,
                                     const DisplacementOf& displacement, const RecordedMesh& mesh,
                                     const ErrorView* view = nullptr);

}  // namespace tessera
