#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tessera {

/// A folder that goes away with the test.
class TestFolder {
  public:
    TestFolder();
    ~TestFolder();
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Names in the folder, sorted; those of hidden files too.
    std::vector<std::string> names() const;

  private:
    std::filesystem::path path_;
};

/// How a program that was run came to its end.
struct ProgramEnd {
    int exit_code = -1;  ///< -1: a signal ended it
    int signal = 0;
    bool timed_out = false;
    std::string out;
    std::string err;      ///< without the lines of progress: how many there are is the machine's affair
    double peak_mib = 0;  ///< resident memory

    std::string text() const;  ///< all of it, for a failed check's message
};

struct ProgramLimits {
    unsigned cpu_seconds = 300;         ///< SIGXCPU beyond: busy machines slow the clock, not this
    unsigned wall_seconds = 550;        ///< killed beyond, with all its children
    unsigned long long file_bytes = 0;  ///< largest file, as by `ulimit -f`; 0: any
};

using Environment = std::vector<std::pair<std::string, std::string>>;

/// Runs a program in `folder`, as a user would, with nothing on standard input; neither output is a terminal.
/// `environment` is set on top of the test's own.
ProgramEnd run_program(const std::vector<std::string>& command, const std::filesystem::path& folder,
                       const ProgramLimits& limits = {}, const Environment& environment = {});

using Arguments = std::vector<std::string>;
Arguments operator+(Arguments a, const Arguments& b);

/// The same for `tessera` with these arguments.
ProgramEnd run_tessera(const Arguments& arguments, const std::filesystem::path& folder,
                       const ProgramLimits& limits = {});

/// The same where exit code 0 is required and nothing on standard error.
ProgramEnd succeed(const Arguments& arguments, const std::filesystem::path& folder);

std::string read_all(const std::filesystem::path& file);
void write_all(const std::filesystem::path& file, const std::string& content);
std::vector<std::string> lines_of(const std::string& text);

/// The folder the project's sources lie in.
std::filesystem::path source_folder();

/// Memory of a program under a sanitizer says nothing, and its time little.
constexpr bool sanitized =
#ifdef TESSERA_SANITIZE
    true;
#else
    false;
#endif

}  // namespace tessera
