#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbench/commands/bake_command.h"
#include "testbench/commands/rank_command.h"
#include "testbench/commands/render_command.h"
#include "testbench/commands/tune_command.h"
#include "testbench/commands/widths_command.h"

namespace tessera {

/// The command line's contents.
struct Command {
    enum class Verb { run, compare, render, bake, tune, rank, widths, keys } verb = Verb::run;
    std::string job_file;               ///< empty: the default job
    std::string run_folder;             ///< compare: what a run left
    std::vector<std::string> settings;  ///< --set a.b=value, in order
    std::filesystem::path data_folder;  ///< what `data:` paths begin at
    bool dump_config = false;           ///< print the effective job and stop
    bool fst = false;                   ///< waveforms also as FST
    RenderRequest render;               ///< Verb::render
    BakeRequest bake;                   ///< Verb::bake
    TuneOrder tune;                     ///< Verb::tune
    RankOrder rank;                     ///< Verb::rank
    WidthsOrder widths;                 ///< Verb::widths
    std::string trace_option;           ///< --trace or --trace-units, if given: it requires --vcd, --fst or --timeline
};

/// Reads the command line. Prints help or version itself; the result is then empty. Throws InputError on wrong usage.
std::optional<Command> read_command_line(int argc, const char* const* argv);

}  // namespace tessera
