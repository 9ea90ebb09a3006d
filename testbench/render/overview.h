#pragma once
#include "testbench/render/image.h"
#include "testbench/render/render_mesh.h"
#include "testbench/render/style.h"
#include "testbench/render/view.h"

namespace tessera {

struct OverviewOptions {
    int width = 1600;
    int height = 0;  ///< 0: what the mesh's proportions ask for, 0.3 to 0.6 times the width
    ColourBy colour_by = ColourBy::generation;
    bool whole_viewport =
        false;  ///< true: show all the run's camera saw; false: enlarge what there is of the mesh
};

/// The default picture of a run: left the surface, shaded; right the same view with its triangles, coloured,
/// and what the colours mean. `view` is the run's camera.
Image render_overview(const RenderMesh& mesh, const View& view, const OverviewOptions& options = {});

}  // namespace tessera
