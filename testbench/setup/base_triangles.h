#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "modules/datapath/parameters.h"
#include "modules/datapath/vertex.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/setup/model_scale.h"

namespace tessera {

/// A base mesh as the host sends it.
struct BaseTriangles {
    std::vector<datapath::Triangle> triangles;  ///< in the mesh's order, of generation 0; base: their number
    std::uint64_t dropped = 0;                  ///< that rounding made name one vertex twice
    std::uint64_t texture_clamped = 0;          ///< vertices whose u or v lay outside a clamped map
    std::uint64_t saturated_positions = 0;      ///< components of vertices
    std::uint64_t saturated_directions = 0;     ///< components of normals and tangents
    std::vector<std::string> remarks;           ///< one sentence each, for the report
};

/// In: a mesh in model units, its texture coordinates in maps. Out: positions in world units, normals and tangents of
/// unit length, texture coordinates in texels (moved by whole periods towards 0 where the map repeats), each in its
/// format. Throws InputError if a texture coordinate does not fit its format, or no triangle is left.
BaseTriangles round_base_triangles(const BaseMesh& mesh, const ModelScale& model_scale,
                                   const datapath::Formats& formats, const datapath::MapGeometry& map);

}  // namespace tessera
