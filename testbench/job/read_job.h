#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// Reads a TOML job file; keys it does not name keep their defaults. Throws one InputError for all
/// faults of the file, with a line "FILE:LINE:COLUMN: ..." for each (at most 20). A file over 1 MiB is refused. Checks
/// each key alone: call validate (validate_job.h) when --set has been applied.
Job read_job(const std::filesystem::path& path);

/// The same for text at hand; `name` stands for the file in messages. Job::folder stays empty.
Job parse_job(std::string_view text, const std::string& name);

/// Applies "table.key=value", one --set of the command line. The value is TOML; text, paths and choices need
/// no quotes. A relative path is relative to the current directory (job_paths.h). Throws
/// InputError naming the setting; the job is then unchanged.
void apply_setting(Job& job, std::string_view setting);

/// Applies all of them, a preset (hardware.design) first: the keys it sets may stand before or after it, as in a file.
/// Throws what apply_setting throws; the job may then be changed in part.
void apply_settings(Job& job, const std::vector<std::string>& settings);

/// The job in a file (empty: the default job) with its --set settings, valid, its paths resolved. data_folder: what
/// `data:` paths begin at. Throws what reading and validating throw.
Job load_job(const std::string& file, const std::vector<std::string>& settings,
             const std::filesystem::path& data_folder);

}  // namespace tessera
