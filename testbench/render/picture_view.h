#pragma once
#include <string_view>

#include "testbench/render/style.h"

namespace tessera {

/// The content of a picture of a run.
enum class PictureView {
    overview,    ///< the shaded surface beside its triangles by generation: a run's picture.png
    shaded,      ///< the surface, lit with the displaced normals
    wireframe,   ///< the shaded surface with the triangles' edges
    generation,  ///< triangles coloured by generation
    test,        ///< by the test that split their parent
    stopped,     ///< by the test that kept an edge whole
    error,       ///< by the distance to a reference surface (RenderMesh::triangle_errors)
};

inline constexpr PictureView picture_views[] = {PictureView::overview,   PictureView::shaded, PictureView::wireframe,
                                                PictureView::generation, PictureView::test,   PictureView::stopped,
                                                PictureView::error};

/// The name on the command line and in file names.
std::string_view name_of(PictureView view);

/// The style of a view, except for sizes and lights. The overview has two: shaded and generation.
Style style_of(PictureView view);

}  // namespace tessera
