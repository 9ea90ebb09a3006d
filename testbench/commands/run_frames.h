#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "testbench/common/error.h"
#include "testbench/job/job.h"

namespace tessera {

/// Runs one frame's job to its folder and prints nothing but what went wrong. `name`: for the line of progress. Its
/// results take the place of what a run before left in `replaced`.
using RunFrame =
    std::function<ExitCode(const Job& frame, const std::string& name, const std::filesystem::path& replaced)>;

/// The frames of a job (frame_job.h), one after another, each by `run` in a process of its own: SystemC elaborates once
/// in a process, and a machine that starts anew leaves, by construction, what a plain run of the frame's job
/// leaves. What the hardware would keep from frame to frame (displacement map, Summed Height Table, most
/// registers) is in the figures of what the host sends instead (host_traffic.h).
///
/// All frames are made ready before the first runs, so that one that cannot be is refused at once. When the first is
/// complete, it takes the place of all that an earlier run left in the folder, frames and plain run.
/// When all are done, output.folder holds frames.csv and frames.txt (frame_table.h), and job.toml. A frame whose checks
/// fail (exit code 1) is complete, and the others run; any other failure ends the run there, without these three files.
///
/// A message names the frame that failed; its exit code is returned, 128 + n if signal n ended it. Ctrl-C reaches both
/// processes; when this one ends otherwise, its frame's is sent SIGTERM.
ExitCode run_frames(const Job& asked, const RunFrame& run);

}  // namespace tessera
