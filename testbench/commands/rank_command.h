#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/common/error.h"

namespace tessera {

/// The arguments of `tessera rank`.
struct RankOrder {
    std::string job_file;               ///< empty: the default job
    std::vector<std::string> settings;  ///< --set
    std::string output = "runs/rank";   ///< folder
};

/// Builds the Rank Table of a job's map and base mesh, as a run of the job does, and measures the meshes of a series of
/// thresholds without a simulation. Writes rank_table.bin (the memory's contents), rank_table.json (its format, for a
/// loader) and thresholds.csv (a row per mesh). Throws InputError on wrong usage.
ExitCode rank_command(const RankOrder& order, const std::filesystem::path& data_folder);

}  // namespace tessera
