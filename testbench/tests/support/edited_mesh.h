#pragma once
#include <cstddef>
#include <vector>

#include "testbench/machine/emitted_mesh.h"

namespace tessera {

/// A mesh's triangles, to be edited; a list is converted to a mesh's triangles.
inline std::vector<EmittedTriangle> list_of(const EmittedMesh& mesh) {
    std::vector<EmittedTriangle> triangles;
    for (const EmittedTriangle& triangle : mesh.triangles)
        triangles.push_back(triangle);
    return triangles;
}

/// Applies `change` to every triangle.
template <class Change>
EmittedMesh changed(const EmittedMesh& mesh, const Change& change) {
    std::vector<EmittedTriangle> triangles = list_of(mesh);
    for (EmittedTriangle& triangle : triangles)
        change(triangle);
    return {triangles};
}

/// The first triangles of a mesh.
inline EmittedMesh first_of(const EmittedMesh& mesh, std::size_t count) {
    std::vector<EmittedTriangle> triangles = list_of(mesh);
    triangles.resize(count);
    return {triangles};
}

}  // namespace tessera
