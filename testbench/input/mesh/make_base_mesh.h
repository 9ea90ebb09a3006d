#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "testbench/input/mesh/base_mesh.h"
#include "testbench/job/job.h"

namespace tessera {

/// Quads along u and v of a mesh that is made of quads, of each patch; 0: of a file's or a run's, which is not.
std::array<std::int64_t, 2> quads_of(const Job::Mesh& mesh);

/// The base mesh a job asks for, complete. `file` is job.file resolved to where it lies; it is looked at where
/// reads_file(source). Errors as in built_in.h, obj_reader.h, bezier_patches.h and run_mesh.h.
BaseMesh make_base_mesh(Job::Mesh const& job, std::string const& file);

}  // namespace tessera
