#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "testbench/render/image.h"
#include "testbench/render/render_mesh.h"

namespace tessera {

inline constexpr unsigned last_generation = 12;  // later generations have the same colour

/// A generation's colour, from pale to dark (safe for the colour-blind and in greyscale). It does not depend on the
/// mesh, so that pictures of different runs are comparable.
Colour generation_colour(unsigned generation);

/// From the palette of Okabe and Ito, safe for the colour-blind.
Colour deciding_test_colour(DecidingTest test);

/// The tests that kept a triangle's edges whole although another test requested a split.
enum class Stop : std::uint8_t { none, view, tex_coord, generation, several };
inline constexpr unsigned stops = 5;

/// From a triangle's stopped_by.
Stop stop_of(std::uint8_t stopped_by);

/// From the palette of Okabe and Ito, too.
Colour stop_colour(Stop stop);

/// From pale yellow (0) to dark red (1), with decreasing lightness (ColorBrewer's YlOrRd, safe for the colour-blind and
/// in greyscale); values outside are clamped.
Colour error_colour(double fraction);

/// Linear light, 0..1 per component.
glm::dvec3 to_linear(const Colour& colour);
Colour to_srgb(const glm::vec3& linear);

}  // namespace tessera
