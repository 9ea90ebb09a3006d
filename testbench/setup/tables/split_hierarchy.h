#pragma once
#include <cstdint>
#include <vector>

#include "testbench/setup/quantised_map.h"
#include "testbench/setup/tables/grid_points.h"

namespace tessera {

/// The size in space of a texel along each axis and of a code, over a flat base mesh, all in the same unit.
struct SurfaceSteps {
    double u = 0, v = 0, code = 0;
};

/// The bisection of an edge and of all triangles that share it.
struct EdgeSplit {
    datapath::TexCoord midpoint;        ///< on a repeated axis within the map
    std::uint32_t column = 0, row = 0;  ///< its texel
    std::uint32_t triangles = 0;        ///< number of triangles it replaces by twice as many
    int generation = 0;                 ///< of the midpoint
    double squared_fall = 0;            ///< of the sum of their squared errors, codes^2; negative if it rises
    double largest = 0;                 ///< the largest error in the triangles it replaces, codes
    double reach = 0;  ///< bound on the sum of distances from both ends to a point over these triangles, unit of
                       ///< SurfaceSteps
};

/// `split` bisects a triangle created by `maker`, and so needs it; maker < split.
struct SplitDependency {
    std::uint32_t split = 0, maker = 0;
    double apart = 0;  ///< sum of the distances from the ends of one's edge to those of the other's
};

/// The sequence of edges to bisect until the mesh equals the map at every grid point that midpoints reach. Any subset
/// of it that contains the makers of each of its splits gives a mesh without cracks.
struct SplitHierarchy {
    std::vector<EdgeSplit> splits;
    std::vector<SplitDependency> dependencies;  ///< in the order of the splits
    double least_error = 0;                     ///< the largest error after all splits, codes
};

/// Greedy, top down: the next edge is the one with the largest (max(0, fall) + best fall + 0.8 squared error) * (length
/// / longest)^2 per triangle. fall: of the squared error by its bisection; best fall: with the best height of the
/// midpoint; longest: of the edges of its triangles. Of equal edges, the one that appeared first.
///
/// Edges with the same ends are one edge, and base triangles with the same corners one triangle, also if they are whole
/// periods apart on a repeated axis. Triangles without area in the map are left out. Takes about 4 us and 500 bytes of
/// memory a texel.
SplitHierarchy make_split_hierarchy(const QuantisedMap& map, const std::vector<TextureTriangle>& base,
                                    const datapath::Formats& formats, const SurfaceSteps& steps = {});

}  // namespace tessera
