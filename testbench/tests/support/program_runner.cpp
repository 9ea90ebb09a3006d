#include "testbench/tests/support/program_runner.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <regex>
#include <sstream>
#include <thread>

namespace tessera {

namespace fs = std::filesystem;

std::string ProgramEnd::text() const {
    std::ostringstream text;
    text << "exit code " << exit_code << ", signal " << signal << (timed_out ? ", timed out" : "") << ", peak "
         << peak_mib << " MiB\nstandard output:\n"
         << out << "\nstandard error:\n"
         << err;
    return text.str();
}

namespace {

void limit(int resource, rlim_t value) {
    rlimit now{};
    ::getrlimit(static_cast<__rlimit_resource>(resource), &now);
    now.rlim_cur = std::min(value, now.rlim_max);
    ::setrlimit(static_cast<__rlimit_resource>(resource), &now);
}

void redirect(const char* file, int flags, int descriptor) {
    const int opened = ::open(file, flags, 0600);
    if (opened < 0 || ::dup2(opened, descriptor) < 0)
        ::_exit(126);
    ::close(opened);
}

/// Runs in the child process; does not return.
[[noreturn]] void become(const std::vector<std::string>& command, const fs::path& folder, const fs::path& outputs,
                         const ProgramLimits& limits, const Environment& environment) {
    ::setpgid(0, 0);
    redirect("/dev/null", O_RDONLY, STDIN_FILENO);
    redirect((outputs / "out").c_str(), O_WRONLY | O_CREAT, STDOUT_FILENO);
    redirect((outputs / "err").c_str(), O_WRONLY | O_CREAT, STDERR_FILENO);
    if (::chdir(folder.c_str()) != 0)
        ::_exit(126);
    for (const auto& [name, value] : environment)
        ::setenv(name.c_str(), value.c_str(), 1);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, limits.cpu_seconds);
    if (limits.file_bytes > 0)
        limit(RLIMIT_FSIZE, limits.file_bytes);
    std::vector<char*> arguments;
    std::vector<std::string> copies = command;
    for (std::string& argument : copies)
        arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
}

std::string without_progress(const std::string& text) {
    static const std::regex line("tessera: after \\d+ s at [^\n]*\n");
    return std::regex_replace(text, line, "");
}

}  // namespace

ProgramEnd run_program(const std::vector<std::string>& command, const fs::path& folder, const ProgramLimits& limits,
                       const Environment& environment) {
    const TestFolder outputs;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(limits.wall_seconds);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0)
        become(command, folder, outputs.path(), limits, environment);
    ::setpgid(child, child);  // in parent and child, since either may run first

    ProgramEnd end;
    int status = 0;
    rusage usage{};
    while (::wait4(child, &status, WNOHANG, &usage) == 0) {
        if (!end.timed_out && std::chrono::steady_clock::now() > deadline) {
            end.timed_out = true;
            ::kill(-child, SIGKILL);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (WIFEXITED(status))
        end.exit_code = WEXITSTATUS(status);
    else
        end.signal = WTERMSIG(status);
    end.peak_mib = static_cast<double>(usage.ru_maxrss) / 1024;
    end.out = read_all(outputs.path() / "out");
    end.err = without_progress(read_all(outputs.path() / "err"));
    return end;
}

Arguments operator+(Arguments a, const Arguments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Arguments set(const Arguments& settings) {
    Arguments arguments;
    for (const std::string& setting : settings)
        arguments.insert(arguments.end(), {"--set", setting});
    return arguments;
}

ProgramEnd run_tessera(const Arguments& arguments, const fs::path& folder, const ProgramLimits& limits,
                       const Environment& environment) {
    return run_program(Arguments{tessera_program()} + arguments, folder, limits, environment);
}

ProgramEnd succeed(const Arguments& arguments, const fs::path& folder) {
    ProgramEnd end = run_tessera(arguments, folder);
    INFO(end.text());
    REQUIRE(end.exit_code == 0);
    CHECK(end.err.empty());
    return end;
}

std::string refused(const Arguments& arguments, const fs::path& folder, const std::vector<std::string>& words,
                    int exit_code) {
    const ProgramEnd end = run_tessera(arguments, folder);
    INFO(end.text());
    CHECK(end.exit_code == exit_code);
    CHECK(end.signal == 0);
    CHECK(end.out.empty());
    CHECK(lines_of(end.err).size() == 1);
    CHECK(end.err.rfind("tessera: ", 0) == 0);
    for (const std::string& word : words)
        CHECK_THAT(end.err, Catch::Contains(word));
    return end.err;
}

void refused(const Arguments& arguments, const TestFolder& here, const std::vector<std::string>& words) {
    const std::vector<std::string> before = here.names();
    refused(arguments, here.path(), words);
    CHECK(here.names() == before);
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        lines.push_back(line);
    return lines;
}

std::string tessera_program() {
    return TESSERA_PROGRAM;
}

}  // namespace tessera
