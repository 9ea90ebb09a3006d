#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "testbench/common/error.h"
#include "testbench/job/job.h"

namespace tessera {

/// How a frame ended, and the lines of its summary that a user must see (summary.h).
struct FrameEnd {
    ExitCode code;
    std::string messages;
};

/// Runs one frame's job into its folder and prints errors only. `name`: shown in the progress line. The results replace
/// those of an earlier run in `replaced`.
using RunFrame =
    std::function<FrameEnd(const Job& frame, const std::string& name, const std::filesystem::path& replaced)>;

/// Runs the frames of a job (frame_job.h) in sequence, each by `run` in a process of its own: SystemC elaborates once
/// per process, and a machine started anew gives, by construction, the results of a plain run of the frame's job. Data
/// that the hardware would keep between frames (displacement map, Summed Height Table, most registers) appears in the
/// figures of the host's traffic instead (host_traffic.h). (Decision: a machine that continued would need a reset of
/// every counter, history and trace, and save only simulation time.)
///
/// All frames are prepared before the first runs, so that an invalid one is refused at once. When the first frame is
/// complete, it replaces everything that an earlier run left in the folder, frames and plain run. At the end,
/// output.folder contains frames.csv and frames.txt (frame_table.h), and job.toml. A frame whose checks fail (exit code
/// 1) is complete, and the others run; any other failure ends the run, without these three files.
///
/// Prints each message of the frames once, where it comes first. An error names the frame that failed. Returns its exit code, 128 + n if signal n ended it. Ctrl-C reaches both
/// processes; if this process ends otherwise, SIGTERM is sent to the frame's.
ExitCode run_frames(const Job& asked, const RunFrame& run);

}  // namespace tessera
