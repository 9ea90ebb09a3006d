#pragma once
#include <string>
#include <string_view>

#include "testbench/input/mesh/base_mesh.h"

namespace tessera {

/// The base mesh in a Wavefront OBJ file, complete: triangles, unit normals, tangent frames, texture scale.
///
/// - Each different corner (v, vt, vn) becomes a vertex, in the order of first use; what no face uses is left
/// out.
/// - Polygons are cut as polygon_cutter.h says. Outlines that cross themselves or are not plane load with a
/// repair.
/// - Corners without texture coordinates get the map laid over the mesh's bounding box, seen along its thinnest axis;
///   so do all where no triangle has an area in texture space.
/// - Normals are made unit length; absent or of zero length, they are the smooth ones of smooth_normals.h.
/// - Dropped and counted, with a repair: triangles of zero area or with a vertex twice; a triangle on the
/// same
///   three positions as an earlier one, be it turned over, unless turned over and with normals of its own at
///   all corners (a sheet with two sides).
/// - Other oddities of the surface load with a sentence in `repairs` (surface_flaws.h).
///
/// Errors: as read_obj_text (obj_text.h); InputError also for a file that cannot be read or is no regular
/// file, for one without a triangle left, and for a mesh smaller than smallest_size; ResourceError beyond the
/// limits of mesh_limits.h.
BaseMesh read_obj(std::string const& path);

/// The same from memory; `name` stands for the file in messages.
BaseMesh parse_obj(std::string_view text, std::string const& name);

}  // namespace tessera
