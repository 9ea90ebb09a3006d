#pragma once
#include <glm/glm.hpp>

#include "testbench/render/render_mesh.h"
#include "testbench/render/view.h"

namespace tessera {

/// Chooses a key light suited to the mesh, in the viewer's frame: for a sheet (a displaced plane) a low sun from the
/// left, which brings out its relief; for round shapes a lamp over the viewer's left shoulder.
glm::dvec3 choose_key_light(const RenderMesh& mesh, const View& view);

}  // namespace tessera
