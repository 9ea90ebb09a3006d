#pragma once
#include <vector>

#include "testbench/output/picture/picture.h"
#include "testbench/output/picture/render_mesh.h"
#include "testbench/output/picture/style.h"
#include "testbench/output/picture/view.h"

namespace tessera {

/// Pictures of the mesh: displaced normals interpolated, soft shadows and sky light by rays, 8 samples a pixel. Several
/// styles cost little more than one; the first one's lights and the last one's line width serve all. linear: in linear
/// light too.
/// The same input gives the same bytes, whatever the machine's load. Nothing in sight: the background.
/// Memory beside the mesh: about 100 bytes a triangle, 3 bytes a pixel of each style, 12 more in linear light. Throws
/// ResourceError when it runs out.
std::vector<Picture> render_pictures(const RenderMesh& mesh, const View& view, const std::vector<Style>& styles,
                                     bool linear);

}  // namespace tessera
