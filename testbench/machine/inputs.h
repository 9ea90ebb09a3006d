#pragma once
#include <string>
#include <vector>

#include "testbench/job/job.h"
#include "testbench/machine/resolve_job.h"
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Mesh and map of a job, built, or read from its paths (job_paths.h). Throws InputError and ResourceError as the
/// readers do, and InputError if a file does not match the job's fingerprint.
BaseMesh load_mesh(const Job& job);
HeightMap load_map(const Job& job);

/// Both, and the job with its automatic values derived from them.
struct Inputs {
    BaseMesh mesh;
    HeightMap map;
    ResolvedJob resolved;
};
Inputs load_inputs(const Job& job);

/// What was done to a mesh and a map, a sentence each.
std::vector<std::string> repairs_of(const BaseMesh& mesh, const HeightMap& map);

}  // namespace tessera
