#pragma once
#include <string>

#include "testbench/job/job.h"
#include "testbench/meshes/base_mesh.h"

namespace tessera {

/// The base mesh a job asks for, complete. `file` is job.file resolved to where it lies; it is looked at where
/// reads_file(source). Errors as in built_in.h, obj_reader.h, bezier_patches.h and run_mesh.h.
BaseMesh make_base_mesh(Job::Mesh const& job, std::string const& file);

}  // namespace tessera
