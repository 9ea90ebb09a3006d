#pragma once
#include "testbench/commands/command_line.h"
#include "testbench/common/error.h"

namespace tessera {

/// Runs a job from its file to its run folder and prints a summary: read, quantise, build, run, test for drained,
/// check, write, verdict. With dump_config prints the effective job instead. Throws InputError, ResourceError.
ExitCode run_job(const Command& command);

}  // namespace tessera
