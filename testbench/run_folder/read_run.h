#pragma once
#include <filesystem>
#include <optional>

#include "testbench/job/job.h"
#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// A run read from its folder.
struct RecordedRun {
    std::filesystem::path folder;
    Job job;            ///< the effective job; its paths are resolved, unless only the mesh was requested
    RecordedMesh mesh;  ///< the emitted mesh, without culled triangles
};

/// Reads job.toml and mesh.ply of a run's folder. `data_folder`: folder that `data:` paths refer to; the job's mesh and
/// map files must exist, but are not read (see inputs.h). Without it, only the mesh is wanted, and the job's files need
/// not exist.
///
/// Errors: InputError with file and remedy: no such folder, no job.toml (not a run's folder), an invalid job,
/// mesh or map no longer at the job's path, no mesh.ply (output.ply = false, or the run got stuck), an invalid mesh.ply
/// (ply_reader.h).
RecordedRun read_run(const std::filesystem::path& folder,
                     const std::optional<std::filesystem::path>& data_folder = std::nullopt);

}  // namespace tessera
