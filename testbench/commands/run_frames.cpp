#include "testbench/commands/run_frames.h"

#include <fmt/core.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

#include "testbench/commands/frame_table.h"
#include "testbench/commands/output_folder.h"
#include "testbench/commands/progress.h"
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

/// All frames, refused together if one cannot be, with what the host sends for each.
std::vector<Frame> plan_frames(const Job& asked, ResolvedJob& resolved_job) {
    Progress progress;
    progress.show("reading mesh and map", 0);
    const auto [mesh, map, resolved] = load_inputs(asked);
    resolved_job = resolved;
    const Job& job = resolved_job.job;
    std::vector<Frame> frames;
    std::optional<MachineSetup> before;
    for (std::int64_t k = 0; k < job.frames.count; ++k) {
        progress.show("making the frames ready",
                      static_cast<double>(k) / static_cast<double>(job.frames.count));
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

/// How the process of a frame ended. In that process itself: what it is to return.
struct End {
    bool in_frame = false;
    ExitCode code = ExitCode::fine;
    int signal = 0;  ///< if one ended it
};

End run_in_process(const Frame& frame, const RunFrame& run, const fs::path& replaced) {
    std::fflush(nullptr);  // what waits in a buffer would be printed twice
    const pid_t parent = ::getpid();
    pid_t child = -1;
    std::optional<Interruption::Child> looked_after;
    {
        const Interruption::Delay delay;
        child = ::fork();
        if (child < 0)
            throw std::system_error(errno, std::generic_category(),
                                    fmt::format("{}: no process for it", frame.text()));
        if (child > 0)
            looked_after.emplace(child);
        else
            Interruption::leave_the_line_to_parent();
    }
    End end;
    if (child == 0) {
        end.in_frame = true;
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent)  // it ended before it could be watched
            ::raise(SIGTERM);
        end.code = run(frame.job, frame.row.name + ": ", replaced);
        return end;
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw std::system_error(errno, std::generic_category(), frame.text());
    looked_after.reset();  // a signal that was handed on ends this process here
    if (WIFSIGNALED(status))
        end.signal = WTERMSIG(status);
    else
        end.code = static_cast<ExitCode>(WEXITSTATUS(status));
    return end;
}

void print_failure(const Frame& frame, const std::string& why) {
    std::fflush(stdout);
    fmt::print(stderr, "tessera: {}: {}\n", frame.text(), why);
}

[[noreturn]] void end_by(int signal) {
    std::fflush(nullptr);
    std::signal(signal, SIG_DFL);
    ::raise(signal);
    ::_exit(128 + signal);
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
    for (Frame& frame : frames) {
        Interruption::note(
            fmt::format("at {} of {} frames, complete in {}", rows.size(), frames.size(), folder.string()));
        const End end = run_in_process(frame, run, rows.empty() ? folder : fs::path(frame.job.output.folder));
        if (end.in_frame)
            return end.code;
        const std::string rest =
            fmt::format("; {} of {} frames are complete, in {}", rows.size(), frames.size(), folder.string());
        if (end.signal != 0) {
            print_failure(frame,
                          fmt::format("ended by signal {}, {}{}", end.signal, ::strsignal(end.signal), rest));
            end_by(end.signal);
        }
        if (end.code == ExitCode::check_failed &&
            fs::exists(fs::path(frame.job.output.folder) / "statistics.json")) {
            print_failure(frame,
                          fmt::format("checks failed, see {}/conformance.txt", frame.job.output.folder));
            worst = ExitCode::check_failed;
        } else if (end.code != ExitCode::fine) {
            print_failure(frame, fmt::format("ended with exit code {}{}", static_cast<int>(end.code), rest));
            return end.code;
        }
        read_counts(frame.job.output.folder, frame.row);
        rows.push_back(frame.row);
        const std::string line = frames_line(frame.row);
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
