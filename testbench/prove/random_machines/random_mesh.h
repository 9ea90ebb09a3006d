#pragma once
#include <string>

#include "testbench/common/random.h"
#include "testbench/prove/random_machines/random_map.h"

namespace tessera {

/// A base mesh as OBJ text, up to about 300 triangles, and what kind of mesh it is.
///
/// Closed: spheres with poles and a seam, tori with two, tetrahedra, octahedra and cubes, subdivided. Open: grids,
/// cylinders, fans of up to 60 triangles round one vertex, strips of triangles up to 10,000 times as long as wide.
/// Also what no surface is: pages that share one edge, and a soup of triangles on few vertices. Rows and columns of
/// even or mixed sizes, vertices displaced at random, any size and place in space. Normals left to the reader, tilted
/// at random, or those of each face (creases). Texture coordinates continuous, of a chart per face (seams), or any;
/// scaled, moved, mirrored, snapped to texels of the map.
/// No function of the C library that rounds as it likes: circles are rational, so the text is the same everywhere.
struct RandomMesh {
    std::string kind;
    std::string obj;
};

RandomMesh make_random_mesh(Random& random, const RandomMap& map);

}  // namespace tessera
