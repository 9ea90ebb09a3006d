#pragma once
#include "testbench/commands/command_line.h"
#include "testbench/common/error.h"

namespace tessera {

/// `tessera compare`: measures the mesh of a run's folder against the displaced surface (measure_error.h), prints a
/// table and writes error.json and error.txt beside the mesh. Throws the errors of reading and measuring.
ExitCode compare_run(const Command& command);

}  // namespace tessera
