#pragma once
#include <vector>

#include "testbench/output/picture/picture.h"
#include "testbench/output/picture/picture_options.h"
#include "testbench/output/picture/picture_view.h"
#include "testbench/output/picture/render_mesh.h"
#include "testbench/output/picture/view.h"

namespace tessera {

/// One picture of each view, without company (any view but the overview): the surface, and below it, if there is
/// something to say, a strip with what the colours mean and the caption. Their letters grow with the picture's width
/// and shrink until they fit. `camera` is a run's own (make_view). Views that leave the surface the same room are
/// rendered together, for little more than the price of one; a picture is the same alone and in company.
///
/// Throws ResourceError when memory runs out.
std::vector<Picture> render_views(const RenderMesh& mesh, const View& camera,
                                  const std::vector<PictureView>& views, const PictureOptions& options);

/// The height of a picture that leaves it open.
int picture_height(const RenderMesh& mesh, const View& camera, PictureView view,
                   const PictureOptions& options);

}  // namespace tessera
