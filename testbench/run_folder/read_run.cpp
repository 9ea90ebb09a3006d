#include "testbench/run_folder/read_run.h"

#include <fmt/format.h>

#include "testbench/common/error.h"
#include "testbench/job/job_choices.h"
#include "testbench/job/job_keys.h"
#include "testbench/job/job_paths.h"
#include "testbench/job/read_job.h"
#include "testbench/job/validate_job.h"
#include "testbench/run_folder/ply_reader.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

void find_input(const char* key, const std::string& text, const fs::path& file, const Job& job) {
    if (file.empty() || is_there(file))
        return;
    const bool in_data = text.rfind("data:", 0) == 0;
    throw InputError(fmt::format(
        "{}: {} = \"{}\": {} does not exist; {}", (fs::path(job.folder) / "job.toml").string(), key, text,
        file.lexically_normal().string(),
        in_data ? "name the data folder with --data FOLDER"
                : "restore it where it was when the job ran, or run the job again with the file's new path"));
}

Job read_run_job(const fs::path& folder) {
    std::error_code failed;
    const fs::file_status status = fs::status(folder, failed);
    if (fs::is_regular_file(status))
        throw InputError(fmt::format("{}: is a file; name the run folder that contains it", folder.string()));
    if (!fs::is_directory(status))
        throw InputError(
            fmt::format("{}: no such folder; name the folder of a run, as `tessera run` prints it", folder.string()));
    const fs::path job_file = folder / "job.toml";
    if (!is_there(job_file))
        throw InputError(fmt::format(
            "{}: there is no job.toml, so this is not a run folder, or the run was interrupted; name a folder as "
            "`tessera run` prints it",
            folder.string()));
    Job job = read_job(job_file);
    validate(job);
    return job;
}

void require_numbers(const fs::path& folder, const Job& job) {
    if (const std::string key = automatic_key(job); !key.empty())
        throw InputError(fmt::format("{}: {} = \"auto\", which a run never writes into its folder: run the job again",
                                     (folder / "job.toml").string(), key));
}

RecordedMesh read_mesh(const fs::path& folder, const Job& job) {
    const fs::path mesh_file = folder / "mesh.ply";
    if (!is_there(mesh_file))
        throw InputError(fmt::format(
            "{}: the run left no mesh: {}", mesh_file.string(),
            job.output.ply ? "it deadlocked (exit code 3), was interrupted, or the file was removed; run a "
                             "job that ends, without output.ply=false"
                           : "its job.toml has output.ply = false; run it again with --set output.ply=true"));
    return read_ply(mesh_file);
}

}  // namespace

RecordedRun read_run(const fs::path& folder, const std::optional<fs::path>& data_folder) {
    RecordedRun run;
    run.folder = folder;
    run.job = read_run_job(folder);
    if (data_folder) {
        resolve_paths(run.job, *data_folder);
        find_input("mesh.file", run.job.mesh.file, run.job.mesh.path, run.job);
        find_input("map.file", run.job.map.file, run.job.map.path, run.job);
    }
    run.mesh = read_mesh(folder, run.job);
    require_numbers(folder, run.job);
    return run;
}

}  // namespace tessera
