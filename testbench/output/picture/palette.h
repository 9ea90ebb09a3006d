#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "testbench/output/picture/image.h"
#include "testbench/output/picture/render_mesh.h"

namespace tessera {

inline constexpr unsigned last_generation = 12;  // beyond it all look alike

/// A generation's colour, pale to dark in lightness as in hue (safe for the colour-blind and in grey). It
/// does not depend on the mesh, so pictures of different runs compare.
Colour generation_colour(unsigned generation);

/// From the palette of Okabe and Ito, safe for the colour-blind.
Colour deciding_test_colour(DecidingTest test);

/// Which tests kept a triangle's edges whole that the Normal, Summed Height or Highlight Test would have split.
enum class Stop : std::uint8_t { none, view, tex_coord, generation, several };
inline constexpr unsigned stops = 5;

/// From a triangle's stopped_by.
Stop stop_of(std::uint8_t stopped_by);

/// From the palette of Okabe and Ito, too.
Colour stop_colour(Stop stop);

/// 0 pale yellow to 1 dark red, lightness falling all the way (ColorBrewer's YlOrRd, safe for the colour-blind and in
/// grey); what lies outside has the nearer end's colour.
Colour error_colour(double fraction);

/// Linear light, 0..1 per component.
glm::dvec3 to_linear(const Colour& colour);
Colour to_srgb(const glm::vec3& linear);

}  // namespace tessera
