#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "testbench/check/surface_error/height_field.h"
#include "testbench/input/map/height_map.h"
#include "testbench/input/mesh/base_mesh.h"
#include "testbench/input/surface/displaced_surface.h"
#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// How far an emitted mesh lies from the surface it stands for.
///
/// The reference: DisplacedSurface sampled as in reference_lattice.h, once per Sampling; `interpolated` is the headline
/// (displaced_surface.h says why). The two directions answer different questions: from the reference to the mesh, what
/// of the surface was missed (a hole, an omitted peak); from the mesh to the reference, what the mesh invents. Neither
/// bounds the other; the larger maximum is the Hausdorff distance of the two as sampled.
///
///     reference to mesh   every lattice sample to the nearest point of the mesh. RMS weighted by the area of the base
///                         surface a sample stands for: a third of each base-surface facet around it. Weights depend on
///                         the job alone, so runs of one job compare.
///     mesh to reference   every vertex, every triangle's centroid, and the centroids of m * m congruent parts of every
///                         triangle, m the least that leaves no part's edge longer than a texel along u, along v or in
///                         space, to the nearest facet of the lattice. RMS over the parts, weighted by their area on
///                         the emitted mesh; vertices and centroids count for the maximum only.
///
/// All sums run in a fixed order in double precision: the same run gives the same bytes, on any number of threads.
struct MeasureLimits {
    /// 8.4 million: 724 x 724 texels at full density. More only where that is fewer than three a base triangle.
    std::uint64_t reference_samples = std::uint64_t{1} << 23;
    std::uint64_t mesh_samples = std::uint64_t{1} << 21;  ///< beyond, parts are larger than a texel
    std::function<void(double)> progress;                 ///< told the part done, 0..1, now and then
};

/// Where a maximum is, and what the hardware did there.
struct WorstSpot {
    glm::dvec3 position{0};  ///< of the sample, model units
    glm::dvec2 texture{0};   ///< of the sample, 0..1 spans the map
    std::uint64_t triangle =
        0;  ///< of the emitted mesh, by its place in the file: nearest to the sample, or its own
    std::uint32_t base = 0;                                     ///< that triangle's base triangle
    std::uint8_t generation = 0, split_by = 0, stopped_by = 0;  ///< that triangle's (recorded_mesh.h)
};

/// Distances from one surface to the other, model units. Infinite where the other is empty.
struct DirectedError {
    std::uint64_t samples = 0;
    double max = 0, rms = 0;
    std::optional<WorstSpot> worst;  ///< nothing where no sample was taken or there is no mesh
};

/// For a picture: how wrong an emitted triangle is. Model units.
struct TriangleError {
    float max = 0;            ///< of its samples, corners and centroid too, to the reference
    float rms = 0;            ///< of its parts, weighted by area
    float reference_max = 0;  ///< of the reference samples to which it is the nearest triangle
};

struct SurfaceError {
    DirectedError reference_to_mesh, mesh_to_reference;
    std::vector<double> vertices;  ///< per vertex of the mesh: its distance to the reference, model units
    std::vector<TriangleError> triangles;  ///< per triangle of the mesh

    double hausdorff() const { return std::max(reference_to_mesh.max, mesh_to_reference.max); }
};

struct MeshError {
    double texel = 1;  ///< a texel's length, model units (texel_length())
    double reference_density =
        0;                    ///< samples per texel along an axis, at least; 4 unless the limit lowered it
    double mesh_density = 0;  ///< parts per texel along an edge, at least; 1 unless the limit lowered it
    SurfaceError interpolated, nearest_texel;
    std::optional<VerticalError> vertical;  ///< of height fields
    std::string no_vertical;                ///< why there is none
};

/// Takes some seconds a walk on two cores, whatever the map and mesh: their samples are limited. Memory:
/// about 250 bytes a triangle and 60 MB a core. Errors: InputError if the mesh names base triangles the base
/// mesh lacks; ResourceError beyond height_field.h's limits and when Embree's memory runs out.
MeshError measure_error(const BaseMesh& base, const HeightMap& map, const DisplacementOf& displacement,
                        const RecordedMesh& mesh, const MeasureLimits& limits = {});

/// One way to read the map, for who needs no more.
SurfaceError measure_surface_error(const BaseMesh& base, const HeightMap& map,
                                   const DisplacementOf& displacement, const RecordedMesh& mesh,
                                   Sampling sampling, const MeasureLimits& limits = {});

}  // namespace tessera
