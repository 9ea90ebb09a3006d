#include "testbench/commands/run_frames.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "testbench/commands/frame_table.h"
#include "testbench/commands/progress.h"
#include "testbench/commands/run_files.h"
#include "testbench/commands/summary.h"
#include "testbench/common/atomic_file.h"
#include "testbench/common/atomic_set.h"
#include "testbench/common/interruption.h"
#include "testbench/job/dump_job.h"
#include "testbench/job/frame_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/machine/inputs.h"
#include "testbench/machine/machine_setup.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

struct Frame {
    Job job;
    FrameRow row;

    std::string text() const { return fmt::format("{} (displacement.scale = {})", row.name, row.scale); }
};

MachineSetup set_up(const Frame& frame, const BaseMesh& mesh, const HeightMap& map) {
    try {
        validate(frame.job);
        return make_setup(frame.job, mesh, map);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", frame.text(), error.what()));
    }
}

/// Prepares all frames, with the host's traffic for each. Throws before any of them runs if one is invalid.
std::vector<Frame> plan_frames(const Job& asked, ResolvedJob& resolved_job) {
    Progress progress;
    progress.show("reading mesh and map", 0);
    const auto [mesh, map, resolved] = load_inputs(asked);
    resolved_job = resolved;
    const Job& job = resolved_job.job;
    std::vector<Frame> frames;
    std::optional<MachineSetup> before;
    for (std::int64_t k = 0; k < job.frames.count; ++k) {
        progress.show("preparing the frames", static_cast<double>(k) / static_cast<double>(job.frames.count));
        Frame frame;
        frame.job = frame_job(job, k);
        frame.row.name = frame_name(k);
        frame.row.scale = frame.job.displacement.scale;
        check_output_folder(frame.job.output.folder);
        MachineSetup setup = set_up(frame, mesh, map);
        frame.row.sent = before ? next_frame_traffic(*before, setup) : first_frame_traffic(setup);
        before = std::move(setup);
        frames.push_back(std::move(frame));
    }
    return frames;
}

/// The process of a frame, and what it writes about itself.
struct FrameProcess {
    pid_t process;  // 0 in the child
    int messages;   // the end of a pipe: the child's to write, the parent's to read
};

/// Forks a process for a frame, which gets SIGTERM when this one ends.
FrameProcess fork_frame(const Frame& frame) {
    const auto fail = [&](const char* what) {
        throw std::system_error(errno, std::generic_category(), fmt::format("{}: {}", frame.text(), what));
    };
    std::fflush(nullptr);  // buffered output would be printed twice
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        fail("cannot make a pipe");
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child < 0)
        fail("cannot start a process");
    ::close(ends[child == 0 ? 0 : 1]);
    if (child == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent)  // the parent ended before prctl()
            ::kill(::getpid(), SIGTERM);
    }
    return {child, ends[child == 0 ? 1 : 0]};
}

void send(int pipe, std::string_view text) {
    while (!text.empty()) {
        const ssize_t sent = ::write(pipe, text.data(), text.size());
        if (sent < 0 && errno != EINTR)
            return;  // the parent has ended
        text.remove_prefix(sent < 0 ? 0 : static_cast<std::size_t>(sent));
    }
    ::close(pipe);
}

/// All that is sent until the other end is closed.
std::string receive(int pipe) {
    std::string text;
    std::array<char, 4096> part{};
    for (ssize_t size = 1; size != 0;) {
        size = ::read(pipe, part.data(), part.size());
        if (size < 0 && errno != EINTR)
            break;
        text.append(part.data(), size < 0 ? 0 : static_cast<std::size_t>(size));
    }
    ::close(pipe);
    return text;
}

/// The lines of a frame's messages that no frame before had.
std::string new_lines(const std::string& messages, std::set<std::string>& said) {
    std::string text, line;
    for (std::istringstream lines(messages); std::getline(lines, line);)
        if (said.insert(line).second)
            text += line + '\n';
    return text;
}

/// Exit status of a frame's process: its exit code or, as in shells, 128 plus the signal number.
int wait_for(pid_t child, const Frame& frame) {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw std::system_error(errno, std::generic_category(), frame.text());
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

void print_failure(const Frame& frame, const std::string& why) {
    std::fflush(stdout);
    fmt::print(stderr, "tessera: {}: {}\n", frame.text(), why);
}

}  // namespace

ExitCode run_frames(const Job& asked, const RunFrame& run) {
    ResolvedJob resolved;
    std::vector<Frame> frames = plan_frames(asked, resolved);
    const Job& job = resolved.job;
    const fs::path folder = job.output.folder;
    std::string text = frames_heading();
    fmt::print("{}{}", found_text(resolved.found), text);
    ExitCode worst = ExitCode::fine;
    std::vector<FrameRow> rows;
    std::set<std::string> said;
    for (Frame& frame : frames) {
        Interruption::note(
            fmt::format("at {} of {} frames, complete in {}", rows.size(), frames.size(), folder.string()));
        const FrameProcess child = fork_frame(frame);
        if (child.process == 0) {
            const FrameEnd end =
                run(frame.job, frame.row.name + ": ", rows.empty() ? folder : fs::path(frame.job.output.folder));
            send(child.messages, end.messages);
            return end.code;
        }
        const std::string messages = new_lines(receive(child.messages), said);
        const int code = wait_for(child.process, frame);
        if (code == static_cast<int>(ExitCode::check_failed) &&
            fs::exists(fs::path(frame.job.output.folder) / "statistics.json")) {
            print_failure(frame, fmt::format("checks failed, see {}/report.txt", frame.job.output.folder));
            worst = ExitCode::check_failed;
        } else if (code != static_cast<int>(ExitCode::fine)) {
            print_failure(frame, fmt::format("ended with exit code {}{}; {} of {} frames are complete, in {}", code,
                                             code > 128 ? fmt::format(" ({})", ::strsignal(code - 128)) : "",
                                             rows.size(), frames.size(), folder.string()));
            return static_cast<ExitCode>(code);
        }
        read_counts(frame.job.output.folder, frame.row);
        rows.push_back(frame.row);
        const std::string line = frames_line(frame.row) + messages;
        text += line;
        fmt::print("{}", line);
        std::fflush(stdout);
    }

    const std::string traffic = frames_traffic(rows);
    AtomicSet files;
    write_file(folder / "frames.csv", frames_csv(rows));
    write_file(folder / "frames.txt", text + traffic);
    write_file(folder / "job.toml", dump_job(job, folder));
    files.commit();
    fmt::print("{}  {}\n  results in {}\n", traffic,
               worst == ExitCode::fine ? "no frame failed" : "FRAMES FAILED, see above",
               fs::absolute(folder).lexically_normal().string());
    return worst;
}

}  // namespace tessera
