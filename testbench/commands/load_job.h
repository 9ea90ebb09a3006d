#pragma once
#include <string>
#include <vector>

#include "testbench/job/job.h"

namespace tessera {

/// The job in a file (empty: the default job) with its --set settings, valid. Throws what reading and validating throw.
Job load_job(const std::string& file, const std::vector<std::string>& settings);

}  // namespace tessera
