#include "testbench/job/job_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "testbench/common/error.h"
#include "testbench/job/toml_text.h"

namespace tessera {

namespace {

constexpr std::string_view data_prefix = "data:";

bool is_data_path(std::string_view text) {
    return text.substr(0, data_prefix.size()) == data_prefix;
}

// Symbolic links are resolved: `..` out of a link's target leads elsewhere than `..` out of the link.
std::filesystem::path canonical_folder(const std::filesystem::path& folder) {
    const std::filesystem::path absolute = std::filesystem::absolute(folder.empty() ? "." : folder);
    std::error_code failed;
    const std::filesystem::path canonical = std::filesystem::weakly_canonical(absolute, failed);
    return failed ? absolute.lexically_normal() : canonical;
}

/// The path to open; empty for an empty text.
std::filesystem::path resolve_path(const std::string& text, const std::filesystem::path& job_folder,
                                   const std::filesystem::path& data_folder) {
    if (text.empty())
        return {};
    if (!is_data_path(text))
        return job_folder / text;
    const std::filesystem::path inside = text.substr(data_prefix.size());
    if (inside.empty() || inside.is_absolute() || std::count(inside.begin(), inside.end(), "..") > 0) {
        throw InputError(fmt::format(
            "path \"{}\": after `data:` comes a path inside the data folder, neither absolute nor with `..`",
            printable(text)));
    }
    return data_folder / inside;
}

}  // namespace

void resolve_paths(Job& job, const std::filesystem::path& data_folder) {
    job.mesh.path = resolve_path(job.mesh.file, job.folder, data_folder);
    job.map.path = resolve_path(job.map.file, job.folder, data_folder);
}

std::string rebase_path(const std::string& text, const std::filesystem::path& from_folder,
                        const std::filesystem::path& to_folder) {
    const std::filesystem::path path = text;
    if (text.empty() || is_data_path(text) || path.is_absolute())
        return text;
    const std::filesystem::path from = canonical_folder(from_folder);
    const std::filesystem::path to = canonical_folder(to_folder);
    if (from == to)
        return text;
    // The file itself may be a link; only its folder is resolved, so that its name stays.
    const std::filesystem::path file = canonical_folder((from / path).parent_path()) / path.filename();
    return file.lexically_relative(to).generic_string();
}

}  // namespace tessera
