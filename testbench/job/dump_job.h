#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "testbench/job/job.h"

namespace tessera {

/// The first line of dump_job()'s output; that of a run's own job identifies a run folder.
inline constexpr std::string_view dumped_job_heading = "# A tessera job: every key with its value.";
inline constexpr std::string_view run_job_heading = "# The job of a tessera run: every key with its value.";

/// Returns every key of the job as TOML, with description, unit, range and default as comments. Reading it gives the
/// same settings, and dumping those the same bytes. Paths stay relative to Job::folder.
std::string dump_job(const Job& job);

/// The same for a file in `run_folder`: relative paths are rewritten to be valid there (job_paths.h).
std::string dump_job(const Job& job, const std::filesystem::path& run_folder);

/// The same with only the keys that differ from their defaults, and no comments but `heading`, one line.
std::string dump_short_job(const Job& job, const std::filesystem::path& folder, const std::string& heading);

/// The reference of all job keys: one Markdown table per table of a job file.
std::string document_keys();

/// The same with one row for keys that differ only in the unit or memory they belong to, and names without their table.
std::string summarise_keys();

}  // namespace tessera
