#pragma once
#include <array>
#include <cstdint>

#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

// The built-in base meshes, complete (normals, tangent frames, texture scale). Each quad of the grid is split
// from its (0,0) to its (1,1) corner, as in the paper's planes. Sizes in model units.
//
// The copies of a texture seam (u = 0 and u = 1) have bit-identical position, normal and tangent frame. Errors:
// InputError for columns, rows or a size out of range, with the job file's key; ResourceError for more triangles than
// largest_base_triangles.

/// Flat, z = 0, normal +z, centred on the origin; u along +x over `width`, v along +y over `depth`.
/// 2 * columns * rows triangles. columns, rows: 1..4096.
BaseMesh make_plane(std::int64_t columns, std::int64_t rows, double width, double depth);

/// Number of quads of a lattice (make_lattice) along an axis of `texels` texels.
std::int64_t lattice_quads(std::int64_t texels, bool repeats, std::int64_t spacing);

/// A plane whose vertices lie at texel centres, `spacing` texels apart starting at the first one, so that midpoints lie
/// at centres too. If `spacing` does not divide the map, it extends beyond the last texels' centres by up to `spacing`
/// texels; on a repeated axis it closes if `spacing` divides the map. texels: the map's columns and rows, which cover
/// `width` by `depth`. spacing: a power of two.
BaseMesh make_lattice(const std::array<std::int64_t, 2>& texels, const std::array<bool, 2>& repeats,
                      std::int64_t spacing, double width, double depth);

/// Open, axis z, centred on the origin, normals outward; u runs counter-clockwise seen from +z, with u = 0.5
/// towards -y; v along +z. 2 * columns * rows triangles. columns: 3..4096, rows: 1..4096.
BaseMesh make_cylinder(std::int64_t columns, std::int64_t rows, double radius, double height);

/// Centred on the origin, axis z, normals outward; u as on the cylinder, v from the south pole to the north
/// by latitude. A pole has one vertex per triangle, with u at that triangle's middle. 2 * columns * (rows - 1)
/// triangles. columns: 3..4096, rows: 2..4096. A repair reports that the directions of dp/du cancel at both
/// poles.
BaseMesh make_sphere(std::int64_t columns, std::int64_t rows, double radius);

}  // namespace tessera
