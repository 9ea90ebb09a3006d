#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/common/atomic_set.h"
#include "testbench/job/job.h"

namespace tessera {

/// A path that names one place in one way, whether or not it is there; without a slash at its end.
std::filesystem::path real_place(const std::filesystem::path& path);

/// The same of the name itself, where a file is written: a link there is not followed.
std::filesystem::path place_of_name(const std::filesystem::path& path);

/// What `files` holds appears in the place of all that a run before it, of one frame or of several, left in
/// `folder`: a job beside the mesh or the picture of another would be believed. What others left there stays:
/// all files of a folder that no run left (its job.toml does not begin with run_job_heading), what has no
/// name of a run's file, what is no plain file; and a frame's folder that holds more.
void replace_run(const std::filesystem::path& folder, AtomicSet& files);

/// Throws InputError if job.output.folder is not one for a run: the root, a folder above the working folder,
/// one in which a file has the name of a run's file and no run left it (frames' folders likewise).
void require_run_folder(const Job& job);

/// Throws InputError if this run would take away what it reads: the run of mesh.source = "run" lies in output.folder or
/// is a frame in it, or a mesh or map file there has the name of one that a run leaves.
void require_inputs_stay(const Job& job);

/// Throws InputError if one of the files that `--output` has written would take the place of one that the job is made
/// from: the job file (if there is one), its mesh or its map.
void require_inputs_kept(const std::string& output, const std::vector<std::filesystem::path>& written,
                         const std::string& job_file, const Job& job);

}  // namespace tessera
