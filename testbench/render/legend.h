#pragma once
#include <cstdint>

#include "testbench/render/image.h"
#include "testbench/render/render_mesh.h"
#include "testbench/render/style.h"

namespace tessera {

/// What the colours of a style mean for this mesh; (x, y) is where its letters begin, on
/// their base line; numbers reach legend_descent below. Nothing with
/// ColourBy::none.
void draw_legend(Image& image, double x, double y, const RenderMesh& mesh, ColourBy colour_by);

/// Its width in pixels.
double legend_width(const RenderMesh& mesh, ColourBy colour_by);

inline constexpr double legend_letter = 10;  ///< height of its letters and boxes, pixels
inline constexpr double legend_descent = 14;
inline constexpr Colour legend_ink{84, 86, 90};

}  // namespace tessera
