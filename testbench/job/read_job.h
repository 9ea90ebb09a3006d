#pragma once
#include <filesystem>
#include <string>
#include <string_view>

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

}  // namespace tessera
