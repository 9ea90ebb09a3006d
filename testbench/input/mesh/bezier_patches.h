#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/input/mesh/base_mesh.h"

namespace tessera {

/// Bicubic Bezier patches, as M. Newell wrote his teapot down in 1975.
///
///     P(u, v) = sum over i, j of b_i(u) b_j(v) points[patch[4 j + i]]      b: cubic Bernstein polynomials
struct BezierPatches {
    std::vector<glm::dvec3> points;                      ///< model units
    std::vector<std::array<std::uint32_t, 16>> patches;  ///< indices into points: u runs fastest
};

/// Reads Newell's format, text: the number of patches; a line for each, 16 numbers of points separated by commas,
/// counted from 1; the number of points; a line for each, x,y,z. Empty lines and blanks do not matter.
///
/// Errors: InputError with file and line for a file that cannot be read, is cut off or goes on behind its last point,
/// for what is no number, a number of a point that is not there, a coordinate beyond largest_coordinate; ResourceError
/// beyond the limits of mesh_limits.h.
BezierPatches read_bezier_patches(std::string const& path);

/// The same from memory; `name` stands for the file in messages.
BezierPatches parse_bezier_patches(std::string_view text, std::string const& name);

/// The patches as a base mesh, complete: `columns` by `rows` quads each, cut from (0,0) to (1,1); texture coordinates
/// 0..1 on every patch; normals cross(dP/du, dP/dv), which is the side the triangles are seen from.
///
/// - Where a border of a patch is collapsed to a point the normal is its limit from inside the patch. Where there is
///   none either (a cusp), the smooth one of smooth_normals.h; a repair counts these vertices.
/// - Triangles of zero area, as at a collapsed border, are dropped and counted, with a repair.
/// - Patches that share a border's control points share its vertices' positions bit for bit, whichever way it runs.
///   Normals within 1e-6 of each other at one position are made the same. Other oddities of the surface load with a
///   sentence in `repairs` (surface_flaws.h).
///
/// `name` stands for the file in messages. Errors: InputError for columns or rows not 1..largest_grid, naming the
/// job's key, when no triangle is left, and for a mesh smaller than smallest_size; ResourceError for more triangles
/// than largest_base_triangles.
BaseMesh make_patch_mesh(BezierPatches const& patches, std::int64_t columns, std::int64_t rows,
                         std::string const& name);

}  // namespace tessera
