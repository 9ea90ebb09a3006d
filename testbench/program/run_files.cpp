#include "testbench/program/run_files.h"

#include <fmt/format.h>

#include <system_error>
#include <vector>

#include "testbench/common/error.h"
#include "testbench/job/frame_job.h"
#include "testbench/job/job_paths.h"
#include "testbench/program/render_command.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

/// A path that names one place in one way; without a slash at its end.
fs::path real_place(const fs::path& folder) {
    std::error_code failed;
    const fs::path absolute = fs::absolute(folder).lexically_normal();
    const fs::path path = fs::weakly_canonical(absolute, failed);
    const fs::path& result = failed ? absolute : path;
    return result.has_filename() ? result : result.parent_path();
}

}  // namespace

void remove_run_file(const fs::path& file) {
    std::error_code absent;
    if (fs::is_regular_file(fs::symlink_status(file, absent)))
        fs::remove(file);
}

void remove_results(const fs::path& folder) {
    for (const char* const name :
         {"job.toml", "mesh.ply", "mesh.obj", "statistics.json", "statistics.csv", "conformance.txt",
          "conformance.json", "timing.txt", "queue_levels.csv", "picture.png", "error.json", "error.txt"})
        remove_run_file(folder / name);
    remove_pictures(folder);
}

void remove_run_files(const fs::path& folder) {
    remove_results(folder);
    for (const char* const name : {"trace.vcd", "trace.fst", "timeline.json"})
        remove_run_file(folder / name);
}

void remove_frames(const fs::path& folder) {
    remove_run_file(folder / "frames.csv");
    remove_run_file(folder / "frames.txt");
    std::error_code failed;
    std::vector<fs::path> frames;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed))
        if (is_frame_name(entry.path().filename().string()))
            frames.push_back(entry.path());
    for (const fs::path& frame : frames) {
        if (fs::is_symlink(fs::symlink_status(frame, failed)) || !fs::exists(frame / "job.toml", failed))
            continue;
        remove_run_files(frame);
        fs::remove(frame, failed);  // unless something else lies there
    }
}

void require_base_stays(const Job& job, const fs::path& data_folder) {
    if (job.mesh.source != MeshSource::run)
        return;
    const fs::path base = real_place(resolve_path(job.mesh.file, job.folder, data_folder));
    const fs::path output = real_place(job.output.folder);
    if (base == output || (base.parent_path() == output && is_frame_name(base.filename().string())))
        throw InputError(fmt::format(
            "output.folder = \"{}\": the run would take away its own base mesh, that of mesh.file "
            "= \"{}\"; choose another output.folder",
            job.output.folder, job.mesh.file));
}

}  // namespace tessera
