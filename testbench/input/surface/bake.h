#pragma once
#include <cstddef>
#include <vector>

#include "testbench/input/mesh/base_mesh.h"
#include "testbench/input/surface/surface_file.h"
#include "testbench/job/job.h"

namespace tessera {

/// A curved surface sampled at texel centres (the paper's section 2.7): what a displacement map is made of.
struct BakedMap {
    int width = 0, height = 0;
    /// Displacement at the centre of texel (x, y): values[y * width + x], y = 0 the bottom row, model units.
    std::vector<double> values;

    std::size_t absent = 0;     ///< texels where the surface is absent
    std::size_t raised = 0;     ///< texels where it is lower than its floor
    double floor = 0;           ///< what the absent ones got, and the raised ones
    std::size_t uncovered = 0;  ///< texels whose centre no base triangle covers
    std::size_t overlaps = 0;   ///< texels whose centre lies inside of several base triangles
};

/// Heights over the plane z = 0. Texel (x, y) of a quadric is at low + (x + 0.5, y + 0.5) / (width, height) of the
/// domain; of a NURBS patch at that part of its parameters. Sides 1..4096. Throws InputError where a quadric
/// is nowhere.
BakedMap bake_heights(const Surface& surface, int width, int height);

/// A quadric over a base mesh: at each texel's centre the base triangle that covers it in texture space gives the
/// position p and the normal n, both interpolated, n then made unit length, and the value is the displacement t from p
/// along n to the quadric, p + t n; by default to the nearest of the two intersections.
///
/// - Texture coordinates are taken as a run takes them: set to the border on an axis that `map` clamps, periodic on one
///   that it repeats.
/// - Where several triangles cover a texel's centre the first in the mesh counts (overlaps); a map cannot hold more
///   than one surface.
/// - A texel whose centre no triangle covers gets the value of the covered one that is nearest in steps from texel to
///   texel, along u first: vertices on a border of the covered part may read it.
///
/// The displaced points lie on the quadric whatever the base mesh. The normal map takes the base surface for
/// as smooth as its normals, so a coarse round base shows its facets in the shading: half the angle between
/// two of them at most.
///
/// Throws InputError where no triangle covers any texel's centre, and where the quadric is nowhere; ResourceError for
/// triangles that span more than 2^31 texels together.
BakedMap bake_over_mesh(const QuadricSurface& surface, const BaseMesh& mesh, const Job::Map& map, int width,
                        int height);

}  // namespace tessera
