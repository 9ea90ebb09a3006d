#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "testbench/input/map/height_map.h"
#include "testbench/input/mesh/base_mesh.h"
#include "testbench/input/surface/displaced_surface.h"
#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// A base mesh on which the displaced surface is a height over a plane: all vertices in one plane, all normals the
/// plane's own (both to 1e-6), texture coordinates an affine function of position that can be undone (to a thousandth
/// of a texel).
struct HeightField {
    glm::dvec3 origin{0}, normal{0};  ///< of the plane, model units
    glm::dvec3 u{0}, v{0};  ///< texel coordinate = texel_origin + (dot(u, p - origin), dot(v, p - origin))
    glm::dvec2 texel_origin{0};

    glm::dvec2 texel(const glm::dvec3& p) const {
        return texel_origin + glm::dvec2(glm::dot(u, p - origin), glm::dot(v, p - origin));
    }
    double height(const glm::dvec3& p) const { return glm::dot(normal, p - origin); }
};

/// Nothing if it is not one; `why` then says in a few words what it lacks.
std::optional<HeightField> find_height_field(const BaseMesh& base, const HeightMap& map,
                                             const DisplacementOf& displacement, std::string& why);

/// The error as terrain simplification measures it: at every grid point of the map, a texel's centre, the mesh's height
/// over the plane there against the map's value there. Both ways to sample the map agree at texel centres. A grid point
/// under several triangles (a shared edge, a fold) counts with the largest of its errors. On an axis that repeats,
/// every copy of the map the base mesh has counts.
struct VerticalError {
    std::uint64_t grid_points = 0;  ///< texel centres on the base mesh
    std::uint64_t covered = 0;      ///< those of them the emitted mesh lies over; only they count below
    double max = 0, rms = 0;        ///< model units; every grid point weighs the same
    double map_unit = 0;        ///< model units that one unit of the map's source stands for; 0: scale is 0
    glm::dvec2 worst_texel{0};  ///< the grid point of the maximum, in texels
    glm::dvec3 worst_position{0};      ///< on the displaced surface, model units
    std::uint64_t worst_triangle = 0;  ///< the emitted triangle over it
};

/// Evaluated in bands of rows of at most 2^22 grid points: 40 MB whatever the map's size. ResourceError beyond 2^32
/// grid points.
VerticalError measure_vertical_error(const HeightField& field, const BaseMesh& base, const HeightMap& map,
                                     const DisplacementOf& displacement, const RecordedMesh& mesh);

}  // namespace tessera
