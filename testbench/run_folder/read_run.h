#pragma once
#include <filesystem>

#include "testbench/job/job.h"
#include "testbench/run_folder/recorded_mesh.h"

namespace tessera {

/// A run as it lies in its folder.
struct RecordedRun {
    std::filesystem::path folder;
    Job job;            ///< the effective job; its paths resolved, unless read for the mesh alone
    RecordedMesh mesh;  ///< what it emitted, but for culled triangles
};

/// Reads job.toml and mesh.ply of a folder that `tessera run` left. `data_folder`: what `data:` paths begin at; the
/// job's mesh and map files are looked for, not read (inputs.h does that).
///
/// Errors: InputError with file and what to do: no such folder, no job.toml (not a run's folder), a folder of frames, a
/// job that is not valid, mesh or map no longer where the job says, no mesh.ply (the run had a fault, wrote none,
/// output.ply = false, or got stuck), a mesh.ply that is not one (ply_reader.h).
RecordedRun read_run(const std::filesystem::path& folder, const std::filesystem::path& data_folder);

/// The same for the mesh alone: what the run itself was made from need not be there any more.
RecordedRun read_run(const std::filesystem::path& folder);

}  // namespace tessera
