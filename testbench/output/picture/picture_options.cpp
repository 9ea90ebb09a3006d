#include "testbench/output/picture/picture_options.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr double usual_line = 1.1;  // in a surface of usual_width

}  // namespace

double line_width(const PictureOptions& options, int width) {
    // Slower than the picture: a larger one is to show finer triangles, too.
    return options.line_width > 0 ? options.line_width : usual_line * std::sqrt(std::max(1.0, width / usual_width));
}

}  // namespace tessera
