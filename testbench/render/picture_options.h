#pragma once
#include <cstdint>

#include "testbench/render/style.h"

namespace tessera {

// Limits on pictures, in pixels: large enough for a legend; small enough for a few minutes and a gigabyte.
inline constexpr int least_picture_side = 64;
inline constexpr int most_picture_side = 16384;
inline constexpr std::int64_t most_picture_pixels = 33'554'432;  // total over all views

/// A close-up: its centre as fractions (0..1) of the unzoomed picture, from the left and from the top, and the
/// magnification.
struct Zoom {
    double across = 0.5, down = 0.5;
    double factor = 1;
};

struct PictureOptions {
    int width = 1600;
    int height = 0;               ///< 0: from the mesh's proportions, 0.3 to 1.3 times the width
    bool whole_viewport = false;  ///< show all the camera sees; else the visible mesh, as large as it fits
    Zoom zoom;
    double line_width = 0;  ///< pixels; 0: chosen by the picture's size
    ErrorScale errors;      ///< for PictureView::error
};

/// Width in pixels of the surface for which line widths and the legend are specified.
inline constexpr double usual_width = 800;

}  // namespace tessera
