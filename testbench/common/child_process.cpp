#include "testbench/common/child_process.h"

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
#include <system_error>

#ifdef TESSERA_COVERAGE
extern "C" int __llvm_profile_write_file();  // NOLINT(bugprone-reserved-identifier): the runtime's own name
#endif

namespace tessera {

namespace {

void write_all(int pipe, const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t written = ::write(pipe, text.data() + done, text.size() - done);
        if (written < 0)
            return;  // the reader has closed the pipe
        done += static_cast<std::size_t>(written);
    }
}

std::string read_all(int pipe) {
    std::string text;
    std::array<char, 4096> some{};
    for (;;) {
        const ssize_t count = ::read(pipe, some.data(), some.size());
        if (count > 0)
            text.append(some.data(), static_cast<std::size_t>(count));
        else if (count == 0 || errno != EINTR)
            return text;
    }
}

/// Exits at once, without destroying what the parent also owns (test sessions, open files).
[[noreturn]] void do_and_tell(const std::function<std::string()>& work, unsigned most_seconds, int pipe) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    ::alarm(most_seconds);
    int code = 0;
    try {
        write_all(pipe, work());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        code = 1;
    }
    std::fflush(nullptr);
#ifdef TESSERA_COVERAGE
    __llvm_profile_write_file();
#endif
    ::_exit(code);
}

}  // namespace

ChildEnd run_in_child(const std::function<std::string()>& work, unsigned most_seconds) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot open a pipe to a process");
    std::fflush(nullptr);  // buffered output would be printed twice
    const pid_t child = ::fork();
    if (child < 0)
        throw std::system_error(errno, std::generic_category(), "cannot start a process");
    if (child == 0) {
        ::close(pipe[0]);
        do_and_tell(work, most_seconds, pipe[1]);
    }
    ::close(pipe[1]);
    ChildEnd end;
    end.told = read_all(pipe[0]);
    ::close(pipe[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "cannot wait for a process");
    if (WIFSIGNALED(status))
        end.failure = fmt::format("ended by signal {}, {}{}", WTERMSIG(status), ::strsignal(WTERMSIG(status)),
                                  WTERMSIG(status) == SIGALRM ? fmt::format(": over {} s", most_seconds) : "");
    else if (WEXITSTATUS(status) != 0)
        end.failure = fmt::format("ended with exit code {}", WEXITSTATUS(status));
    return end;
}

}  // namespace tessera
