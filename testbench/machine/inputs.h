#pragma once
#include "testbench/setup/height_map.h"
#include "testbench/setup/mesh/base_mesh.h"
#include "testbench/job/job.h"
#include "testbench/machine/resolve_job.h"

namespace tessera {

/// Mesh and map of a job, built or read from where its paths (job_paths.h) say.
/// Throws InputError, ResourceError as the readers do, and InputError on a file of another fingerprint than the job's.
BaseMesh load_mesh(const Job& job);
HeightMap load_map(const Job& job);

/// Both, and the job with what it leaves to the program found from them.
struct Inputs {
    BaseMesh mesh;
    HeightMap map;
    ResolvedJob resolved;
};
Inputs load_inputs(const Job& job);

}  // namespace tessera
