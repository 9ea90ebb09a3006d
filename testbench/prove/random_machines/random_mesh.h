#pragma once
#include <string>

#include "testbench/common/random.h"
#include "testbench/prove/random_machines/random_map.h"

namespace tessera {

/// A base mesh as OBJ text, up to about 300 triangles, and a description of its kind.
///
/// Closed: spheres with poles and a seam, tori with two, tetrahedra, octahedra and cubes, subdivided. Open: grids,
/// cylinders, fans of up to 60 triangles round one vertex, strips of triangles up to 10,000 times as long as wide. Also
/// non-surfaces: pages that share one edge, and a soup of triangles on few vertices. Rows and columns of even or mixed
/// sizes, vertices displaced at random, any size and place in space. Normals left to the reader, tilted at random, or
/// those of each face (creases). Texture coordinates continuous, of a chart per face (seams), or arbitrary; scaled,
/// moved, mirrored, snapped to texels of the map. Uses no C library function with unspecified rounding: circles are
/// rational, so the text is the same everywhere.
struct RandomMesh {
    std::string kind;
    std::string obj;
};

RandomMesh make_random_mesh(Random& random, const RandomMap& map);

}  // namespace tessera
