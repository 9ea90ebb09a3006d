#pragma once
#include <vector>

#include "testbench/output/picture/image.h"
#include "testbench/output/picture/picture.h"
#include "testbench/output/picture/render_mesh.h"
#include "testbench/output/picture/style.h"
#include "testbench/output/picture/view.h"

namespace tessera {

/// A picture of the mesh: displaced normals interpolated, soft shadows and sky light by rays, 8 samples a pixel.
/// The same input gives the same bytes, whatever the machine's load. Nothing in sight: the background.
/// Memory beside the mesh: about 100 bytes a triangle, 3 bytes a pixel. Throws ResourceError when it runs out.
Image render(const RenderMesh& mesh, const View& view, const Style& style);

/// The same view in several styles for little more than the price of one; the first one's lights and the last one's
/// line width serve all.
std::vector<Image> render_styles(const RenderMesh& mesh, const View& view, const std::vector<Style>& styles);

/// The same, in linear light too if wanted; 12 bytes a pixel more.
std::vector<Picture> render_pictures(const RenderMesh& mesh, const View& view, const std::vector<Style>& styles,
                                     bool linear);

}  // namespace tessera
