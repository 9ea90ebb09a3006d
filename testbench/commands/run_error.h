#pragma once
#include <vector>

#include "testbench/run_folder/read_run.h"

namespace tessera {

/// How far a run's mesh lies from the surface it stands for, for a picture. Model units.
struct RunError {
    std::vector<float> triangles;  ///< per triangle the largest distance found, either way (measure_error.h)
    double texel = 1;              ///< a texel's length
};

/// Reads the run's mesh and map anew and measures against the map read between its samples (Sampling::interpolated), as
/// `tessera compare` does. About 5 s for 200,000 triangles. Throws what reading and measuring throw.
RunError measure_run_error(const RecordedRun& run);

}  // namespace tessera
