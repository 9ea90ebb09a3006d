#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "testbench/check/conformance/golden_inputs.h"
#include "testbench/machine/emitted_mesh.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

/// A Phong highlight: (N' . H)^exponent, light and viewer infinitely far.
struct Highlight {
    glm::dvec3 half_vector{0, 0, 1};  ///< unit length
    double angle = 25;                ///< degrees from H within which a normal counts as in the highlight
    int exponent = 32;                ///< at least 0
};

/// The error of specular light interpolated over each emitted triangle from its three vertices (Gouraud), against the
/// light of each texel's own displaced normal. Full scale: the light's intensity where N' = H.
struct GouraudError {
    double rms = 0;            ///< over the base mesh's texels, equally weighted
    double highlight_rms = 0;  ///< over the texels whose own normal lies in the highlight; 0 if there are none
    double largest = 0;
    std::uint64_t texels = 0, highlight_texels = 0;
    double highlight_triangles = 0;  ///< emitted triangles per texel in the highlight
    double other_triangles = 0;      ///< the same, elsewhere
};

/// Texel centres on the border of two triangles count in both; a triangle without a texel centre is ignored. The true
/// normal: base normal and tangent interpolated over the base triangle, bumped in double precision.
GouraudError measure_gouraud(const EmittedMesh& mesh, const MachineSetup& setup, const GoldenInputs& inputs,
                             const Highlight& highlight);

}  // namespace tessera
