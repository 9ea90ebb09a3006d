#pragma once
#include <cstdint>

#include "testbench/output/picture/image.h"
#include "testbench/output/picture/render_mesh.h"
#include "testbench/output/picture/style.h"

namespace tessera {

/// What the colours of a style mean for this mesh; (x, y) is where its letters begin, on
/// their base line; numbers reach scale * legend_descent below. Nothing with ColourBy::none. What falls outside the
/// image is cut off.
void draw_legend(Image& image, double x, double y, const RenderMesh& mesh, const Style& style,
                 double scale = 1);

/// Its width in pixels.
double legend_width(const RenderMesh& mesh, const Style& style, double scale = 1);

inline constexpr double legend_letter = 10;  ///< height of its letters and boxes at scale 1, pixels
inline constexpr double legend_descent = 14;
inline constexpr Colour legend_ink{84, 86, 90};

}  // namespace tessera
