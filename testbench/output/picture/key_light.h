#pragma once
#include <glm/glm.hpp>

#include "testbench/output/picture/render_mesh.h"
#include "testbench/output/picture/view.h"

namespace tessera {

/// A key light that shows a mesh well, in the viewer's frame: over a sheet (a displaced plane) a low sun from the left,
/// so that its relief stands out; for anything round a lamp over the viewer's left shoulder.
glm::dvec3 choose_key_light(const RenderMesh& mesh, const View& view);

}  // namespace tessera
