#pragma once
#include <filesystem>
#include <optional>

#include "testbench/job/job.h"
#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// A run as read from its folder.
struct RecordedRun {
    std::filesystem::path folder;
    Job job;            ///< the effective job; its paths resolved, unless read for the mesh alone
    RecordedMesh mesh;  ///< what it emitted, without culled triangles
};

/// Reads job.toml and mesh.ply of a folder that `tessera run` left. `data_folder`: what `data:` paths begin at; the
/// job's mesh and map files must exist, but are not read (inputs.h does that). None: for the mesh alone, and the job's
/// files need not exist any more.
///
/// Errors: InputError with file and what to do: no such folder, no job.toml (not a run's folder), a folder of frames, a
/// job that is not valid, mesh or map no longer where the job says, no mesh.ply (output.ply =
/// false, or the run got stuck), a mesh.ply that is not one (ply_reader.h).
RecordedRun read_run(const std::filesystem::path& folder,
                     const std::optional<std::filesystem::path>& data_folder = std::nullopt);

}  // namespace tessera
