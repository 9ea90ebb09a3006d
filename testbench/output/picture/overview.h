#pragma once
#include "testbench/output/picture/picture.h"
#include "testbench/output/picture/picture_options.h"
#include "testbench/output/picture/render_mesh.h"
#include "testbench/output/picture/view.h"

namespace tessera {

/// The default picture of a run: left the surface, shaded; right the same view with its triangles, coloured by
/// generation, and what the colours mean. Below the left one the caption; without one, how many triangles the mesh has.
/// Height, if it is left open: 0.3 to 0.6 times the width. `camera` is the run's.
Picture render_overview(const RenderMesh& mesh, const View& camera, const PictureOptions& options = {});

/// The height of an overview that leaves it open.
int overview_height(const RenderMesh& mesh, const View& camera, const PictureOptions& options);

}  // namespace tessera
