#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "testbench/bake/displaced_surface.h"
#include "testbench/compare/height_field.h"
#include "testbench/run_folder/recorded_mesh.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// The distance between an emitted mesh and the exact displaced surface.
///
/// The reference is DisplacedSurface sampled as in reference_lattice.h, once per Sampling; `interpolated` is the main
/// figure (see displaced_surface.h). The distance from the reference to the mesh shows features that the mesh misses
/// (a hole, an omitted peak), the distance from the mesh to the reference features that the surface does not have.
/// Neither bounds the other; the larger maximum is the Hausdorff distance of the samples.
///
///     reference to mesh   every lattice sample to the nearest point of the mesh. RMS weighted by a sample's share of
///                         the base surface: a third of each base-surface facet around it. Weights depend on the job
///                         alone, so that runs of one job are comparable.
///     mesh to reference   every vertex, every triangle's centroid, and the centroids of m * m congruent parts of every
///                         triangle, to the nearest facet of the lattice; m is the least for which no part's edge is
///                         longer than a texel along u, along v or in space. RMS over the parts, weighted by their area
///                         on the emitted mesh; vertices and centroids count for the maximum only.
///
/// Where a base mesh extends beyond a map that clamps (BaseMesh::beyond_map), samples beyond it do not count: nothing
/// in the map is there. They are part of the errors of single vertices and triangles, which pictures show.
///
/// All sums are formed in a fixed order in double precision: the result is bit-identical on any number of threads.
struct MeasureLimits {
    /// 8.4 million: 724 x 724 texels at full density. Exceeded only to give each base triangle three.
    std::uint64_t reference_samples = std::uint64_t{1} << 23;
    std::uint64_t mesh_samples = std::uint64_t{1} << 21;  ///< beyond, parts are larger than a texel
    std::function<void(double)> progress;                 ///< called with the fraction done, 0..1
    const ErrorView* view = nullptr;                      ///< for vertical errors in the picture
};

/// The place of a maximum and the hardware's decisions there.
struct WorstSpot {
    glm::dvec3 position{0};      ///< of the sample, model units
    glm::dvec2 texture{0};       ///< of the sample, 0..1 spans the map
    std::uint64_t triangle = 0;  ///< index in the file of the emitted triangle nearest to the sample, or containing it
    std::uint32_t base = 0;      ///< that triangle's base triangle
    std::uint8_t generation = 0, split_by = 0, stopped_by = 0;  ///< that triangle's (recorded_mesh.h)
};

/// Distances from one surface to the other, model units. Infinite if the other is empty.
struct DirectedError {
    std::uint64_t samples = 0;
    double max = 0, rms = 0;
    std::optional<WorstSpot> worst;  ///< nothing if there are no samples or no mesh
};

/// The error of an emitted triangle, for pictures. Model units.
struct TriangleError {
    float max = 0;            ///< over its samples, corners and centroid, to the reference
    float rms = 0;            ///< over its parts, weighted by area
    float reference_max = 0;  ///< over the reference samples nearest to this triangle
};

struct SurfaceError {
    DirectedError reference_to_mesh, mesh_to_reference;
    std::vector<double> vertices;          ///< per vertex of the mesh: its distance to the reference, model units
    std::vector<TriangleError> triangles;  ///< per triangle of the mesh

    double hausdorff() const { return std::max(reference_to_mesh.max, mesh_to_reference.max); }
};

struct MeshError {
    double texel = 1;              ///< a texel's length, model units (texel_length())
    double reference_density = 0;  ///< minimum samples per texel along an axis; 4 unless the limit lowered it
    double mesh_density = 0;       ///< minimum parts per texel along an edge; 1 unless the limit lowered it
    std::uint64_t beyond_map = 0;  ///< samples of the reference beyond the map, which do not count
    SurfaceError interpolated, nearest_texel;
    std::optional<VerticalError> vertical;  ///< for height fields
    std::string no_vertical;                ///< the reason if there is none
};

/// Takes some seconds per walk on two cores for any map and mesh, since samples are limited. Memory: about 250 bytes
/// per triangle and 60 MB per core. Errors: InputError if the mesh names base triangles that the base mesh lacks;
/// ResourceError beyond height_field.h's limits.
MeshError measure_error(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                        const RecordedMesh& mesh, const MeasureLimits& limits = {});

/// Measures with one sampling method only.
SurfaceError measure_surface_error(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                                   const RecordedMesh& mesh, Sampling sampling, const MeasureLimits& limits = {});

}  // namespace tessera
