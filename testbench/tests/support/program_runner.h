#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "testbench/tests/support/sanitized.h"
#include "testbench/tests/support/source_folder.h"
#include "testbench/tests/support/test_folder.h"

namespace tessera {

/// The end of a program's run.
struct ProgramEnd {
    int exit_code = -1;  ///< -1: a signal ended it
    int signal = 0;
    bool timed_out = false;
    std::string out;
    std::string err;      ///< without progress lines, whose number depends on the machine's speed
    double peak_mib = 0;  ///< resident memory

    std::string text() const;  ///< all of the above, for a failed check's message
};

struct ProgramLimits {
    unsigned cpu_seconds = 300;         ///< SIGXCPU beyond; CPU time does not depend on other load
    unsigned wall_seconds = 550;        ///< killed beyond, with all its children
    unsigned long long file_bytes = 0;  ///< largest file, as `ulimit -f`; 0: no limit
};

using Environment = std::vector<std::pair<std::string, std::string>>;

/// Runs a program in `folder` with an empty standard input; neither output is a terminal. `environment` is added to the
/// test's own.
ProgramEnd run_program(const std::vector<std::string>& command, const std::filesystem::path& folder,
                       const ProgramLimits& limits = {}, const Environment& environment = {});

using Arguments = std::vector<std::string>;
Arguments operator+(Arguments a, const Arguments& b);

/// --set before each of these.
Arguments set(const Arguments& settings);

/// The same for `tessera` with these arguments.
ProgramEnd run_tessera(const Arguments& arguments, const std::filesystem::path& folder,
                       const ProgramLimits& limits = {}, const Environment& environment = {});

/// The same; requires exit code 0 and an empty standard error.
ProgramEnd succeed(const Arguments& arguments, const std::filesystem::path& folder);

/// The same; requires this exit code and a message of one line with these words alone; gives the message.
std::string refused(const Arguments& arguments, const std::filesystem::path& folder,
                    const std::vector<std::string>& words = {}, int exit_code = 2);

/// The same; requires that nothing was added to the folder or taken from it.
void refused(const Arguments& arguments, const TestFolder& here, const std::vector<std::string>& words);

std::vector<std::string> lines_of(const std::string& text);

/// The path of `tessera`.
std::string tessera_program();

}  // namespace tessera
