#include "testbench/commands/run_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

#include "testbench/commands/render_command.h"
#include "testbench/common/error.h"
#include "testbench/job/dump_job.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

constexpr const char* run_file_names[] = {"job.toml",       "mesh.ply",         "mesh.obj",   "statistics.json",
                                          "statistics.csv", "conformance.json", "report.txt", "queue_levels.csv",
                                          "picture.png",    "error.json",       "trace.vcd",  "trace.fst"};

/// Whether a run, or a command on a run, writes or removes a file of this name.
bool is_run_file(const std::string& name) {
    const std::vector<std::string> pictures = picture_names();
    const auto among = [&](const auto& names) {
        return std::find(std::begin(names), std::end(names), name) != std::end(names);
    };
    return among(run_file_names) || among(pictures);
}

bool is_there(const fs::path& path) {
    std::error_code absent;
    return fs::exists(fs::symlink_status(path, absent));
}

void take_away_plain(const fs::path& file, AtomicSet& files) {
    std::error_code absent;
    if (fs::is_regular_file(fs::symlink_status(file, absent)))
        files.take_away(file);
}

/// Whether this folder was written by a run.
bool is_run_folder(const fs::path& folder) {
    std::ifstream job(folder / "job.toml");
    std::string first;
    return std::getline(job, first) && first == run_job_heading;
}

/// The names of a run's files that exist in a folder, whatever their type.
std::vector<std::string> names_taken(const fs::path& folder) {
    std::vector<std::string> names(std::begin(run_file_names), std::end(run_file_names));
    const std::vector<std::string> pictures = picture_names();
    names.insert(names.end(), pictures.begin(), pictures.end());
    names.erase(
        std::remove_if(names.begin(), names.end(), [&](const std::string& name) { return !is_there(folder / name); }),
        names.end());
    return names;
}

/// Absolute, without a trailing slash.
fs::path plain(const fs::path& path) {
    const fs::path absolute = fs::absolute(path).lexically_normal();
    return absolute.has_filename() ? absolute : absolute.parent_path();
}

}  // namespace

fs::path real_place(const fs::path& path) {
    std::error_code failed;
    const fs::path absolute = fs::absolute(path).lexically_normal();
    const fs::path canonical = fs::weakly_canonical(absolute, failed);
    const fs::path& result = failed ? absolute : canonical;
    return result.has_filename() ? result : result.parent_path();
}

fs::path place_of_name(const fs::path& path) {
    const fs::path absolute = fs::absolute(path).lexically_normal();
    return real_place(absolute.parent_path()) / absolute.filename();
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

void check_output_folder(const fs::path& folder, const std::string& key) {
    const auto refuse = [&](const std::string& why) {
        throw InputError(fmt::format("{} = \"{}\": cannot write there: {}; choose another", key, folder.string(), why));
    };
    std::error_code error;
    fs::path there = plain(folder);
    while (!is_there(there) && there.has_relative_path())
        there = there.parent_path();
    if (!fs::is_directory(there, error))
        refuse(fmt::format("{} is not a folder", there.string()));
    if (access(there.c_str(), W_OK | X_OK) != 0)
        refuse(fmt::format("{}: {}", there.string(), std::generic_category().message(errno)));
}

void check_folder_of(const fs::path& file, const std::string& option) {
    const fs::path folder = folder_of(file);
    std::error_code error;
    if (!fs::is_directory(folder, error))
        throw InputError(
            fmt::format("{} {}: there is no folder {}; create it first", option, file.string(), folder.string()));
    check_output_folder(folder, option);
}

void replace_run(const fs::path& folder, AtomicSet& files) {
    if (is_run_folder(folder)) {
        for (const char* const name : run_file_names)
            take_away_plain(folder / name, files);
        for (const std::string& name : picture_names())
            take_away_plain(folder / name, files);
    }
    files.commit();
}

void require_run_folder(const Job& job) {
    const auto refuse = [&](const std::string& why) {
        throw InputError(fmt::format("output.folder = \"{}\": {}", job.output.folder, why));
    };
    const fs::path output = real_place(job.output.folder);
    const fs::path inside = fs::current_path().lexically_relative(output);
    if (!output.has_relative_path() || (inside != "." && *inside.begin() != ".."))
        refuse("contains the current directory; name a folder for this run only");
    const std::vector<std::string> taken = names_taken(output);
    if (!taken.empty() && !is_run_folder(output))
        refuse(
            fmt::format("the run would replace {}, but the folder is not a run folder of tessera: move the file, or "
                        "choose another output.folder",
                        (output / taken.front()).string()));
}

void require_inputs_stay(const Job& job) {
    const fs::path output = real_place(job.output.folder);
    const auto refuse = [&](const char* what, const char* key, const std::string& file) {
        throw InputError(
            fmt::format("output.folder = \"{}\": the run would remove its own {}, {} = \"{}\"; "
                        "choose another output.folder",
                        job.output.folder, what, key, file));
    };
    const auto taken = [&](const fs::path& file) {
        for (const fs::path& place : {place_of_name(file), real_place(file)})
            if (place.parent_path() == output && is_run_file(place.filename().string()))
                return true;
        return false;
    };
    if (job.mesh.source == MeshSource::run ? real_place(job.mesh.path) == output
                                           : reads_file(job.mesh.source) && taken(job.mesh.path))
        refuse("base mesh", "mesh.file", job.mesh.file);
    if (job.map.source == MapSource::file && taken(job.map.path))
        refuse("map", "map.file", job.map.file);
}

void require_inputs_kept(const std::string& output, const std::vector<fs::path>& written, const std::string& job_file,
                         const Job& job) {
    for (const fs::path& to : written)
        for (const fs::path& from : {fs::path(job_file), job.mesh.path, job.map.path})
            if (!from.empty() && (place_of_name(to) == place_of_name(from) || place_of_name(to) == real_place(from)))
                throw InputError(fmt::format("--output {}: {} would overwrite {}, an input; choose another name",
                                             output, to.string(), from.string()));
}

}  // namespace tessera
