#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// Reads a TOML job file; keys that it does not contain keep their defaults. Throws one InputError for all faults of
/// the file, with a line "FILE:LINE:COLUMN: ..." for each (at most 20). A file over 1 MiB is refused. Checks each key
/// separately: call validate (validate_job.h) after --set has been applied.
Job read_job(const std::filesystem::path& path);

/// The same for text in memory; `name` stands for the file in messages. Job::folder stays empty.
Job parse_job(std::string_view text, const std::string& name);

/// Applies "table.key=value", one --set of the command line. The value is TOML; text, paths and choices need no quotes.
/// A relative path is relative to the current directory (job_paths.h). Throws InputError that names the setting; the
/// job is then unchanged.
void apply_setting(Job& job, std::string_view setting);

/// Applies all settings, a preset (hardware.design) first: the keys it sets may be before or after it, as in a file.
/// Throws as apply_setting does; the job may then be partly changed.
void apply_settings(Job& job, const std::vector<std::string>& settings);

/// Loads the job in a file (empty: the default job) with its --set settings, validates it and resolves its paths.
/// data_folder: folder that `data:` paths refer to. Throws the errors of reading and validating.
Job load_job(const std::string& file, const std::vector<std::string>& settings,
             const std::filesystem::path& data_folder);

}  // namespace tessera
