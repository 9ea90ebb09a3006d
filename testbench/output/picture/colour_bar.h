#pragma once
#include "testbench/output/picture/image.h"
#include "testbench/output/picture/style.h"

namespace tessera {

/// The legend of an error picture: a bar of error_colour() from 0 to the largest error, with round numbers of model
/// units below it and, if the texel's size is known, of texels above it. (x, y) is the lower left corner of its first
/// letter; it reaches scale * legend_descent below, and as much above its letters.
void draw_colour_bar(Image& image, double x, double y, const ErrorScale& errors, double scale);

/// Its width in pixels.
double colour_bar_width(const ErrorScale& errors, double scale);

/// A step of 1, 2 or 5 times a power of ten, so that 0..largest has two to five of them; 0 for none.
double round_step(double largest);

}  // namespace tessera
