#pragma once
#include <string_view>

#include "testbench/output/picture/style.h"

namespace tessera {

/// What a picture of a run shows.
enum class PictureView {
    overview,    ///< the surface shaded beside the same with its triangles by generation: a run's picture.png
    shaded,      ///< the surface, lit with the displaced normals
    wireframe,   ///< the same with its triangles' edges
    generation,  ///< triangles coloured by generation
    test,        ///< by the test that split their parent
    stopped,     ///< by the test that kept an edge whole
    error,       ///< by the distance to a reference surface (RenderMesh::triangle_errors)
};

inline constexpr PictureView picture_views[] = {PictureView::overview,   PictureView::shaded, PictureView::wireframe,
                                                PictureView::generation, PictureView::test,   PictureView::stopped,
                                                PictureView::error};

/// As on the command line, and in the names of files.
std::string_view name_of(PictureView view);

/// How a view looks, except for sizes and lights. The overview is two: shaded and generation.
Style style_of(PictureView view);

}  // namespace tessera
