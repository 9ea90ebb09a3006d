#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/common/atomic_set.h"
#include "testbench/job/job.h"

namespace tessera {

/// The canonical form of a path, whether or not it exists, without a trailing slash.
std::filesystem::path real_place(const std::filesystem::path& path);

/// The same for a file to be written: a symbolic link of that name is not followed.
std::filesystem::path place_of_name(const std::filesystem::path& path);

/// The folder of a file: "." if its path names none.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Checks before a long run that its folder can be written, without creating it. `key`: the setting named in messages.
/// Throws InputError.
void check_output_folder(const std::filesystem::path& folder, const std::string& key = "output.folder");

/// The same for the folder of a file named by an option. The folder must exist.
void check_folder_of(const std::filesystem::path& file, const std::string& option);

/// Replaces everything that an earlier run left in `folder` by `files`, so that results of different runs never mix.
/// Kept: the contents of a folder that no run wrote (its job.toml does not begin with run_job_heading), names that no run
/// writes, and anything but regular files.
void replace_run(const std::filesystem::path& folder, AtomicSet& files);

/// Throws InputError if job.output.folder is unsuitable: the root, a folder above the working folder, or one that no
/// run wrote and that contains a file with the name of a run's file.
void require_run_folder(const Job& job);

/// Throws InputError if this run would remove its own input: the run of mesh.source = "run" is in output.folder, or a
/// mesh or map file there has the name of a run's file.
void require_inputs_stay(const Job& job);

/// Throws InputError if a file that the command writes because of `--output` would overwrite an input: the job file (if
/// there is one), its mesh or its map.
void require_inputs_kept(const std::string& output, const std::vector<std::filesystem::path>& written,
                         const std::string& job_file, const Job& job);

}  // namespace tessera
