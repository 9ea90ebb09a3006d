#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// The job in a file (empty: the default job) with its --set settings, valid, its paths resolved. data_folder: what
/// `data:` paths begin at. Throws what reading and validating throw.
Job load_job(const std::string& file, const std::vector<std::string>& settings,
             const std::filesystem::path& data_folder);

}  // namespace tessera
