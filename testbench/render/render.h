#pragma once
#include <vector>

#include "testbench/render/picture.h"
#include "testbench/render/render_mesh.h"
#include "testbench/render/style.h"
#include "testbench/render/view.h"

namespace tessera {

/// Renders pictures of the mesh: interpolated displaced normals, soft shadows and sky light by ray tracing, 8 samples
/// per pixel. Several styles cost little more than one; all use the first one's lights and the last one's line width.
/// The same input gives the same bytes, whatever the machine's load. If nothing is in sight: the background. Memory
/// besides the mesh: about 100 bytes per triangle, 3 bytes per pixel of each style. Throws ResourceError when it runs
/// out.
std::vector<Picture> render_pictures(const RenderMesh& mesh, const View& view, const std::vector<Style>& styles);

}  // namespace tessera
