#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "testbench/job/job.h"
#include "testbench/setup/mesh/base_mesh.h"

namespace tessera {

/// Quads along u and v of a built-in mesh; 0 for the mesh of a file or a run.
std::array<std::int64_t, 2> quads_of(const Job::Mesh& mesh);

/// The complete base mesh of a job. `file` is the resolved path of job.file, used if reads_file(source). Errors as in
/// built_in.h, obj_reader.h and run_mesh.h.
BaseMesh make_base_mesh(const Job::Mesh& job, const std::string& file);

}  // namespace tessera
