#pragma once
#include <vector>

#include "testbench/run_folder/read_run.h"

namespace tessera {

/// Distance of a run's mesh from the displaced surface, for a picture. Model units.
struct RunError {
    std::vector<float> triangles;  ///< per triangle the largest distance found, either way (measure_error.h)
    double texel = 1;              ///< a texel's length
};

/// Reads the run's base mesh and map and measures against the interpolated map (Sampling::interpolated), as
/// `tessera compare` does. About 5 s for 200,000 triangles. Throws the errors of reading and measuring.
RunError measure_run_error(const RecordedRun& run);

}  // namespace tessera
