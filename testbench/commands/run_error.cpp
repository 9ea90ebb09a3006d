#include "testbench/commands/run_error.h"

#include <algorithm>

#include "testbench/check/surface_error/measure_error.h"
#include "testbench/machine/inputs.h"

namespace tessera {

RunError measure_run_error(const RecordedRun& run) {
    const BaseMesh base = load_mesh(run.job);
    const HeightMap map = load_map(run.job);
    const SurfaceError error =
        measure_surface_error(base, map, DisplacementOf::from(run.job, map), run.mesh, Sampling::interpolated);
    RunError result;
    result.texel = texel_length(base, map);
    result.triangles.reserve(error.triangles.size());
    for (const TriangleError& triangle : error.triangles)
        result.triangles.push_back(std::max(triangle.max, triangle.reference_max));
    return result;
}

}  // namespace tessera
