#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "testbench/common/error.h"

namespace tessera {

/// The command line of `tessera run`.
struct Command {
    std::string job_file;               ///< empty: the default job
    std::vector<std::string> settings;  ///< --set a.b=value, in order
    std::filesystem::path data_folder;  ///< folder that `data:` paths refer to
    bool dump_config = false;           ///< print the effective job and stop
    bool fst = false;                   ///< waveforms also as FST
    std::string trace_option;           ///< --trace or --trace-units, if given; requires --vcd or --fst
};

/// Returns the command to call; empty for help or version, which are then already printed. Throws InputError on wrong
/// usage.
std::function<ExitCode()> read_command_line(int argc, const char* const* argv);

}  // namespace tessera
