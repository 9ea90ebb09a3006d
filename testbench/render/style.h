#pragma once
#include <glm/glm.hpp>

#include "testbench/render/image.h"

namespace tessera {

enum class ColourBy { none, generation, deciding_test };

/// How a picture looks. Lights are in the viewer's frame: x right, y up, z towards the viewer.
struct Style {
    ColourBy colour_by = ColourBy::none;
    bool wireframe = false;
    bool legend = false;      ///< in the lower left corner; nothing with ColourBy::none
    double line_width = 1.1;  ///< pixels
    Colour surface{222, 214, 202};
    Colour background{250, 250, 248};
    glm::dvec3 key_light{-0.52, 0.46, 0.72};
};

}  // namespace tessera
