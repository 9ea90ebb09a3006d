#pragma once
#include <cstdint>

#include "testbench/output/picture/style.h"

namespace tessera {

// Limits of pictures, in pixels: room for a legend; at most a few minutes and a gigabyte.
inline constexpr int least_picture_side = 64;
inline constexpr int most_picture_side = 16384;
inline constexpr std::int64_t most_picture_pixels = 33'554'432;  // of all views together

/// A close-up: its centre, from the left (0..1) and the top (0..1) of the picture without zoom, and the
/// magnification.
struct Zoom {
    double across = 0.5, down = 0.5;
    double factor = 1;
};

struct PictureOptions {
    int width = 1600;
    int height = 0;               ///< 0: from the mesh's proportions, 0.3 to 1.3 times the width
    bool whole_viewport = false;  ///< all the camera saw; else what there is of the mesh, as large as it fits
    Zoom zoom;
    double line_width = 0;  ///< pixels; 0: suits the picture's size
    ErrorScale errors;      ///< for PictureView::error
    bool linear = false;    ///< linear light, too
};

/// Of a surface, in pixels: what line widths and the legend are given for.
inline constexpr double usual_width = 800;

}  // namespace tessera
