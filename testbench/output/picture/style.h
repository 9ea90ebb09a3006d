#pragma once
#include <glm/glm.hpp>

#include "testbench/output/picture/image.h"

namespace tessera {

enum class ColourBy { none, generation, deciding_test, stopped_by, error };

/// What the colours of ColourBy::error span; model units.
struct ErrorScale {
    double largest = 0;  ///< the darkest colour; errors beyond look alike. 0: all errors are 0
    double beyond = 0;   ///< the largest error there is, if that is larger: the legend says so
    double texel = 0;    ///< one texel of the map on the surface, for the legend; 0: unknown
};

/// How a picture looks. Lights are in the viewer's frame: x right, y up, z towards the viewer.
struct Style {
    ColourBy colour_by = ColourBy::none;
    bool wireframe = false;
    double line_width = 1.1;  ///< pixels
    Colour surface{222, 214, 202};
    Colour background{250, 250, 248};
    glm::dvec3 key_light{-0.52, 0.46, 0.72};
    ErrorScale errors;
    double relief = 1;  ///< 0..1: how much of light and shadow shows; less where colours are to be read
};

}  // namespace tessera
