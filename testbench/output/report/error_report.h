#pragma once
#include <string>
#include <vector>

#include "testbench/compare/measure_error.h"
#include "testbench/job/job.h"
#include "testbench/output/report/statistics.h"

namespace tessera {

/// Figures of a mesh's error in groups: what was measured and how densely ("measurement"), the main figure
/// ("interpolated") and the other sampling method ("nearest_texel"), height fields' error at the map's grid points
/// ("vertical"), and the places of the maxima ("worst_..."). Infinite values (no mesh) are null in error.json. `job` is
/// used for the tests' names and for remarks.
std::vector<Figure> error_figures(const Job& job, const RecordedMesh& mesh, const MeshError& error);

}  // namespace tessera
