#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "testbench/render/image.h"
#include "testbench/render/render_mesh.h"

namespace tessera {

/// A generation's colour, pale to dark in lightness as in hue (safe for the colour-blind and in grey). It
/// does not depend on the mesh, so pictures of different runs compare; 12 and beyond look alike.
Colour generation_colour(unsigned generation);

/// From the palette of Okabe and Ito, safe for the colour-blind.
Colour deciding_test_colour(DecidingTest test);

/// Linear light, 0..1 per component.
glm::dvec3 to_linear(const Colour& colour);
Colour to_srgb(const glm::dvec3& linear);

}  // namespace tessera
