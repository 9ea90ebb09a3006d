#pragma once
#include <string_view>

#include "testbench/output/picture/image.h"

namespace tessera {

/// Text in capitals with the built-in stroke font; (x, y) is the lower left corner of the first letter,
/// `size` the letters' height, in pixels. Characters the font lacks are left blank; what falls outside the
/// image is cut off.
void draw_text(Image& image, double x, double y, double size, std::string_view text, const Colour& colour);

/// Its width in pixels.
double text_width(double size, std::string_view text);

}  // namespace tessera
