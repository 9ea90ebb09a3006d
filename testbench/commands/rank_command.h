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

/// Makes the Rank Table of a job's map and base mesh, as a run of it does by itself, and measures the meshes of its
/// thresholds without a simulation. Writes rank_table.bin, the table as the memory holds it, rank_table.json, what a
/// loader must know of it, and thresholds.csv, a row a mesh. Throws InputError on wrong usage.
ExitCode rank_command(const RankOrder& order, const std::filesystem::path& data_folder);

}  // namespace tessera
