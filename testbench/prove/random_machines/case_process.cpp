#include "testbench/prove/random_machines/case_process.h"

#include <fmt/core.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <system_error>
#include <type_traits>

#include "testbench/common/exit_process.h"
#include "testbench/common/pipe.h"

namespace tessera {

namespace {

constexpr unsigned most_seconds = 120;

/// Figures and digest as they lie in memory, then the failure's text.
struct Header {
    CaseFigures figures;
    std::uint64_t mesh_digest;
};
static_assert(std::is_trivially_copyable_v<Header>);

[[noreturn]] void run_and_tell(const RandomCase& random_case, Mode mode, int pipe) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    ::alarm(most_seconds);
    CaseResult result;
    try {
        result = run_case(random_case, mode);
    } catch (const std::exception& error) {
        result.failure = error.what();
    }
    const Header header{result.figures, result.mesh_digest};
    write_to_pipe(pipe, &header, sizeof header);
    write_to_pipe(pipe, result.failure.data(), result.failure.size());
    std::fflush(nullptr);
    exit_process(0);
}

}  // namespace

CaseResult run_case_in_process(const RandomCase& random_case, Mode mode) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "no pipe to a case's process");
    std::fflush(nullptr);  // what waits in a buffer would be printed twice
    const pid_t child = ::fork();
    if (child < 0)
        throw std::system_error(errno, std::generic_category(), "no process for a case");
    if (child == 0) {
        ::close(pipe[0]);
        run_and_tell(random_case, mode, pipe[1]);
    }
    ::close(pipe[1]);
    const std::string told = read_from_pipe(pipe[0]);
    ::close(pipe[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "a case's process");

    CaseResult result;
    if (WIFSIGNALED(status) || WEXITSTATUS(status) != 0 || told.size() < sizeof(Header)) {
        result.figures.runs = 1;
        result.failure =
            WIFSIGNALED(status)
                ? fmt::format("ended by signal {}, {}{}", WTERMSIG(status), ::strsignal(WTERMSIG(status)),
                              WTERMSIG(status) == SIGALRM ? fmt::format(": over {} s", most_seconds) : std::string{})
                : fmt::format("ended with exit code {}", WEXITSTATUS(status));
        return result;
    }
    Header header{};
    std::memcpy(&header, told.data(), sizeof header);
    result.figures = header.figures;
    result.mesh_digest = header.mesh_digest;
    result.failure = told.substr(sizeof header);
    return result;
}

}  // namespace tessera
