#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tessera {

/// What the user asked for.
struct Command {
    enum class Verb { run, keys } verb = Verb::run;
    std::string job_file;               ///< empty: the default job
    std::vector<std::string> settings;  ///< --set a.b=value, in order
    std::filesystem::path data_folder;  ///< what `data:` paths begin at
    bool dump_config = false;           ///< print the effective job and stop
    bool fst = false;                   ///< waveforms also as FST
    std::string trace_option;           ///< --trace or --trace-units, if given: it wants something to trace
};

/// Reads the command line. Prints help or version itself and gives nothing then. Throws InputError on wrong usage.
std::optional<Command> read_command_line(int argc, const char* const* argv);

}  // namespace tessera
