#pragma once
#include <filesystem>

#include "testbench/input/mesh/base_mesh.h"

namespace tessera {

/// The mesh that an earlier run emitted, as a base mesh for another map (paper figure 11c): positions P',
/// normals N' and texture coordinates t as in its mesh.ply, in model units; tangent frames as for any mesh
/// (tangent_frames.h). t spans the map of the next run by 0..1, whatever the sizes of the two maps.
///
/// - Vertices alike in P', N' and t are one, so the surface is as closed as it was: two triangles that met at an edge
///   decide alike there again. Vertices of one P' but two normals (a crease, or a seam of the texture along which the
///   map's slope is not continuous) come apart under another map, and surface_flaws() says how many there are.
/// - A triangle that names one vertex twice then is dropped and counted. One without area, but of three
///   vertices, stays: a neighbour may have an edge that is its other two together, and dropping it would
///   leave a T-vertex there.
/// - A normal that the hardware had not (zero) is the smooth one of smooth_normals.h, counted in a repair.
/// - The model's up is the run's camera.up where that run's mesh was a file or a run, else z.
/// - Triangles that the run culled are not in its mesh: the holes are a repair.
///
/// Errors: InputError as in read_run.h, for a mesh without a triangle left, and for one smaller than smallest_size;
/// ResourceError beyond largest_base_triangles. Memory: about 400 bytes a vertex while reading.
BaseMesh read_run_mesh(const std::filesystem::path& folder);

}  // namespace tessera
