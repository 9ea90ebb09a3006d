#pragma once
#include <string>
#include <string_view>

#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// The base mesh in a Wavefront OBJ file, complete: triangles, unit normals, tangent frames, texture scale.
///
/// - Each distinct corner (v, vt, vn) becomes a vertex, in the order of first use; unused ones are omitted.
/// - Polygons are triangulated by polygon_cutter.h. Outlines that are self-intersecting or not planar are accepted with
///   a repair.
/// - Corners without texture coordinates get those of a projection along the bounding box's thinnest axis, with the map
///   spanning the box; so do all corners if no triangle has an area in texture space.
/// - Normals are normalised; missing or zero normals are replaced by those of smooth_normals.h.
/// - Dropped and counted, with a repair: triangles of zero area or with a vertex twice; a triangle at the same three
///   positions as an earlier one, of either winding, unless its winding is opposite and its normals differ at all
///   corners (a two-sided sheet).
/// - Points of the border that rounding separates are joined (border_points.h).
/// - Other anomalies of the surface are accepted with a sentence in `repairs` (surface_flaws.h).
///
/// Errors: as read_obj_text (obj_text.h); InputError also for a file that cannot be read or is not a regular
/// file, if no triangle remains, and for a mesh smaller than smallest_size; ResourceError beyond the limits of
/// mesh_limits.h.
BaseMesh read_obj(const std::string& path);

/// The same from memory; messages show `name` as the file.
BaseMesh parse_obj(std::string_view text, const std::string& name);

}  // namespace tessera
