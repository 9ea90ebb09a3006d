#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// A path that names one place in one way, whether or not it is there; without a slash at its end.
std::filesystem::path real_place(const std::filesystem::path& path);

/// Takes away the file that a run left under this name. What is no plain file stays.
void remove_run_file(const std::filesystem::path& file);

/// Takes away what `tessera run`, `tessera compare` and `tessera render` leave in a run's folder. Other files stay.
void remove_run_files(const std::filesystem::path& folder);

/// Takes away what a run of several frames left in its folder: the table of frames, and every frame's run. A frame's
/// folder that holds other files keeps those; a folder called like a frame's that is no run's is left alone.
void remove_frames(const std::filesystem::path& folder);

/// Throws InputError if this run would take away what it reads: the run of mesh.source = "run" lies in output.folder or
/// is a frame in it, or a mesh or map file there has the name of one that a run leaves.
void require_inputs_stay(const Job& job, const std::filesystem::path& data_folder);

/// Throws InputError if one of the files that `--output` has written would take the place of one that the job is made
/// from: the job file (if there is one), its mesh or its map.
void require_inputs_kept(const std::string& output, const std::vector<std::filesystem::path>& written,
                         const std::string& job_file, const Job& job,
                         const std::filesystem::path& data_folder);

}  // namespace tessera
