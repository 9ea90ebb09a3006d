#pragma once
#include <filesystem>

#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// The mesh emitted by an earlier run, as a base mesh for another map (paper figure 11c): positions P',
/// normals N' and texture coordinates t as in its mesh.ply, in model units; tangent frames as for any mesh
/// (tangent_frames.h). t from 0 to 1 spans the next run's map, whatever the sizes of the two maps.
///
/// - Vertices of equal P', N' and t are merged, so that the surface stays closed: two triangles at a shared edge make
///   the same decision there. Vertices of equal P' but different normals (a crease, or a texture seam along which the
///   map's slope is not continuous) separate under another map; surface_flaws() reports their number.
/// - A triangle that then has one vertex twice is dropped and counted. A triangle without area but with three distinct
///   vertices is kept: its long edge may be a neighbour's edge, and dropping it would leave a T-vertex there.
/// - A zero normal (unknown to the hardware) is replaced by that of smooth_normals.h and counted in a repair.
/// - The model's up is the run's camera.up if that run's mesh came from a file or a run, else z.
/// - Triangles that the run culled are not in its mesh; a repair reports the holes.
///
/// Errors: InputError as in read_run.h, if no triangle remains, and for a mesh smaller than smallest_size;
/// ResourceError beyond largest_base_triangles. Memory: about 400 bytes per vertex while reading.
BaseMesh read_run_mesh(const std::filesystem::path& folder);

}  // namespace tessera
