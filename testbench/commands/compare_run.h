#pragma once
#include <filesystem>

#include "testbench/common/error.h"

namespace tessera {

/// `tessera compare`: measures the mesh of a run's folder against the displaced surface (measure_error.h), prints
/// its figures and writes them as error.json beside the mesh. Throws the errors of reading and measuring.
ExitCode compare_run(const std::filesystem::path& run_folder, const std::filesystem::path& data_folder);

}  // namespace tessera
