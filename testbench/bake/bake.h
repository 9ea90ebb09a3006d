#pragma once
#include <cstddef>
#include <vector>

#include "testbench/bake/surface_file.h"
#include "testbench/job/job.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// A curved surface sampled at texel centres for a displacement map (the paper's section 2.7).
struct BakedMap {
    int width = 0, height = 0;
    /// Displacement at the centre of texel (x, y): values[y * width + x], y = 0 the bottom row, model units.
    std::vector<double> values;

    std::size_t absent = 0;     ///< texels where the surface is absent
    std::size_t raised = 0;     ///< texels where it is lower than its floor
    double floor = 0;           ///< the height of absent and raised texels
    std::size_t uncovered = 0;  ///< texels whose centre no base triangle covers
    std::size_t continued = 0;  ///< of those, texels that hold the surface continued past a triangle
    std::size_t overlaps = 0;   ///< texels whose centre lies inside several base triangles
};

/// In texels: as far as bilinear filtering of N', or of the next level of detail, reads beside a triangle.
constexpr float bake_margin = 4;

/// Heights over the plane z = 0; of a quadric the upper ones by default. Texel (x, y) of a quadric is at low + (x +
/// 0.5, y + 0.5) / (width, height) of the domain; of a NURBS patch at that fraction of its parameters. Sides 1..4096.
/// Where a quadric has no root the map gets its given floor, or its lowest height elsewhere. Throws InputError if no
/// texel meets it.
BakedMap bake_heights(const Surface& surface, int width, int height);

/// A quadric over a base mesh: at each texel's centre the base triangle that covers it in texture space gives the
/// interpolated position p and the interpolated, normalised normal n. The value is the displacement t from p along n to
/// the quadric, p + t n; by default to the nearest of the two intersections.
///
/// - Texture coordinates are treated as in a run: set to the border on an axis that `map` clamps, periodic on an axis
///   that it repeats.
/// - If several triangles cover a texel's centre the first in the mesh counts (overlaps), since a map holds only one
///   surface; so it cannot represent an overhang either.
/// - A texel whose centre no triangle covers, at most `bake_margin` from one, gets the surface over the nearest
///   triangle's plane and linear normals, so that filters and N' are right at the covered part's border; not if the
///   surface is absent there, or does not continue that at the border.
/// - Another gets the value of the nearest texel that has one, counted in texel steps, along u first.
///
/// The displaced points lie on the quadric for any base mesh. The normal map assumes that the base surface is as smooth
/// as its normals, so a coarse round base shows its facets in the shading: at most half the angle between two of them.
///
/// Throws InputError if no triangle covers any texel's centre, and if no texel meets the quadric; ResourceError for
/// triangles that span more than 2^31 texels together.
BakedMap bake_over_mesh(const QuadricSurface& surface, const BaseMesh& mesh, const Job::Map& map, int width,
                        int height);

}  // namespace tessera
