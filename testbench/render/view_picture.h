#pragma once
#include <vector>

#include "testbench/render/picture.h"
#include "testbench/render/picture_options.h"
#include "testbench/render/picture_view.h"
#include "testbench/render/render_mesh.h"
#include "testbench/render/view.h"

namespace tessera {

/// Renders one picture per view: the surface (in the overview two, side by side) and a legend below it. `camera` is the
/// run's (make_view). Surfaces of the same size are rendered together, at little more than the cost of one; a picture
/// does not depend on the other views.
///
/// Throws ResourceError when memory runs out.
std::vector<Picture> render_views(const RenderMesh& mesh, const View& camera, const std::vector<PictureView>& views,
                                  const PictureOptions& options);

/// The height of a picture if the options do not specify it.
int picture_height(const RenderMesh& mesh, const View& camera, PictureView view, const PictureOptions& options);

}  // namespace tessera
