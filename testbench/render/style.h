#pragma once
#include <glm/glm.hpp>

#include "testbench/render/image.h"

namespace tessera {

enum class ColourBy { none, generation, deciding_test, stopped_by, error };

/// The errors that the colours of ColourBy::error span; model units.
struct ErrorScale {
    double largest = 0;  ///< darkest colour, also used beyond. 0: all errors are 0
    double beyond = 0;   ///< the largest error, if it is larger: stated in the legend
    double texel = 0;    ///< size of a texel on the surface, for the legend; 0: unknown
};

/// The style of a picture. Lights are in the viewer's frame: x right, y up, z towards the viewer.
struct Style {
    ColourBy colour_by = ColourBy::none;
    bool wireframe = false;
    double line_width = 1.1;  ///< pixels
    Colour surface{222, 214, 202};
    Colour background{250, 250, 248};
    glm::dvec3 key_light{-0.52, 0.46, 0.72};
    ErrorScale errors;
    double relief = 1;  ///< 0..1: strength of light and shadow; lower if colours must be readable
};

}  // namespace tessera
