#include "testbench/prove/faults/faultless_run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <system_error>

#include "testbench/common/error.h"
#include "testbench/common/exit_process.h"
#include "testbench/common/pipe.h"

namespace tessera {

namespace {

/// Whatever it says is its parent's to say: reports of the kernel, and that it was interrupted.
void fall_silent() {
    const int nowhere = ::open("/dev/null", O_WRONLY);
    for (const int output : {STDOUT_FILENO, STDERR_FILENO})
        ::dup2(nowhere, output);
}

[[noreturn]] void run_and_tell(const std::function<std::vector<Caught>()>& run, pid_t parent, int pipe) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent)  // it ended before it could be watched
        ::raise(SIGTERM);
    fall_silent();
    std::string text;
    try {
        const std::vector<Caught> detected = run();
        if (!detected.empty())
            text = fmt::format("{}: {}", detected.front().by, detected.front().evidence);
    } catch (const std::exception& error) {
        text = error.what();
    }
    write_to_pipe(pipe, text.data(), text.size());
    std::fflush(nullptr);
    exit_process(0);
}

}  // namespace

void require_sound_without_fault(const std::function<std::vector<Caught>()>& run) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "no pipe to the run without the fault");
    std::fflush(nullptr);  // what waits in a buffer would be printed twice
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child < 0)
        throw std::system_error(errno, std::generic_category(), "no process for the run without the fault");
    if (child == 0) {
        ::close(pipe[0]);
        run_and_tell(run, parent, pipe[1]);
    }
    ::close(pipe[1]);
    std::string text = read_from_pipe(pipe[0]);
    ::close(pipe[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "the run without the fault");
    if (WIFSIGNALED(status))
        text = fmt::format("ended by signal {}, {}", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    if (!text.empty())
        throw InputError(fmt::format(
            "the job fails without its fault already, so nothing can be told of the fault: choose a job that "
            "passes with fault.kind = \"none\"; this one: {}",
            text));
}

}  // namespace tessera
