#pragma once
#include "testbench/commands/command_line.h"
#include "testbench/common/error.h"

namespace tessera {

/// `tessera compare`: measures the mesh of a run's folder against the surface it stands for (measure_error.h), prints a
/// table and leaves error.json and error.txt beside the mesh. Throws what reading and measuring throw.
ExitCode compare_run(const Command& command);

}  // namespace tessera
