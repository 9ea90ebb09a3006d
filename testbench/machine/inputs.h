#pragma once
#include <filesystem>

#include "testbench/input/map/height_map.h"
#include "testbench/input/mesh/base_mesh.h"
#include "testbench/job/job.h"
#include "testbench/machine/resolve_job.h"

namespace tessera {

/// Mesh and map of a job, built or read. data_folder: what `data:` paths begin at.
/// Throws InputError, ResourceError as the readers do, and InputError on a file of another fingerprint than the job's.
BaseMesh load_mesh(const Job& job, const std::filesystem::path& data_folder);
HeightMap load_map(const Job& job, const std::filesystem::path& data_folder);

/// Both, and the job with what it leaves to the program found from them.
struct Inputs {
    BaseMesh mesh;
    HeightMap map;
    ResolvedJob resolved;
};
Inputs load_inputs(const Job& job, const std::filesystem::path& data_folder);

}  // namespace tessera
