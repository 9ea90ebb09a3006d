#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Bicubic Bezier patches, as in M. Newell's teapot of 1975.
///
///     P(u, v) = sum over i, j of b_i(u) b_j(v) points[patch[4 j + i]]      b: cubic Bernstein polynomials
struct BezierPatches {
    std::vector<glm::dvec3> points;                      ///< model units
    std::vector<std::array<std::uint32_t, 16>> patches;  ///< indices into points: u runs fastest
};

/// Reads Newell's text format: the number of patches; a line for each with 16 indices of points separated by commas,
/// from 1; the number of points; a line for each, x,y,z. Empty lines and blanks are ignored.
///
/// Errors: InputError with file and line for a file that cannot be read, is truncated or continues after its last
/// point, for text that is not a number, an index without a point, a coordinate beyond largest_coordinate;
/// ResourceError beyond the limits of mesh_limits.h.
BezierPatches read_bezier_patches(const std::string& path);

/// The same from memory; messages show `name` as the file.
BezierPatches parse_bezier_patches(std::string_view text, const std::string& name);

/// Makes a complete base mesh of the patches: `columns` by `rows` quads each, split from (0,0) to (1,1); texture
/// coordinates 0..1 on every patch; normals cross(dP/du, dP/dv), on the front side of the triangles.
///
/// - At a border that is collapsed to a point, where dP/du is zero (the teapot has two), the normal is its limit from
///   inside the patch. If there is no limit (a cusp), it is the smooth normal of smooth_normals.h; a repair counts
///   these vertices.
/// - Triangles of zero area, as at a collapsed border, are dropped and counted, with a repair.
/// - Patches that share a border's control points have bit-identical vertex positions there, in either direction.
///   Normals within 1e-6 of each other at one position are made equal. Other anomalies of the surface are accepted with
///   a sentence in `repairs` (surface_flaws.h).
///
/// Messages show `name` as the file. Errors: InputError for columns or rows not in 1..largest_grid, with the job's key,
/// if no triangle remains, and for a mesh smaller than smallest_size; ResourceError for more triangles than
/// largest_base_triangles.
BaseMesh make_patch_mesh(const BezierPatches& patches, std::int64_t columns, std::int64_t rows,
                         const std::string& name);

}  // namespace tessera
