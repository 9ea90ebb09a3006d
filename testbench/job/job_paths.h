#pragma once
#include <filesystem>
#include <string>

#include "testbench/job/job.h"

namespace tessera {

// Paths in a job
//  * `data:NAME` is NAME inside the data folder, everywhere. It may not be absolute or contain `..`.
//  * A relative path of mesh.file or map.file is relative to the job file's folder (Job::folder). Job keeps the text as
//    given, and resolve_paths() adds the path to open.
//  * --set comes from a command line: there it is relative to the current directory, and apply_setting rewrites it to be
//    relative to Job::folder.
//  * dump_job(job, run_folder) rewrites it to be relative to the run folder, so that the dumped job runs again from where
//    it lies and two checkouts leave the same bytes.
//  * An absolute path stays as it is, everywhere.
//  * output.folder is relative to the current directory, everywhere.

/// Sets mesh.path and map.path, the paths to open; empty if mesh.file or map.file is. Call once, after a job is read
/// and its --set settings are applied. Throws InputError for a `data:` path that leaves the data folder.
void resolve_paths(Job& job, const std::filesystem::path& data_folder);

/// Rewrites `text` so that it means the same from `to_folder` as from `from_folder`.
std::string rebase_path(const std::string& text, const std::filesystem::path& from_folder,
                        const std::filesystem::path& to_folder);

}  // namespace tessera
