#include "testbench/commands/output_folder.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "testbench/common/error.h"

namespace tessera {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& key, const fs::path& folder, const std::string& why) {
    throw InputError(fmt::format("{} = \"{}\": cannot write there: {}; choose another", key, folder.string(), why));
}

bool is_there(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

fs::path plain(const fs::path& folder) {
    const fs::path path = fs::absolute(folder).lexically_normal();
    return path.has_filename() ? path : path.parent_path();  // without a slash at its end
}

}  // namespace

void check_output_folder(const fs::path& folder, const std::string& key) {
    std::error_code error;
    fs::path there = plain(folder);
    while (!is_there(there) && there.has_relative_path())
        there = there.parent_path();
    if (!fs::is_directory(there, error))
        refuse(key, folder, fmt::format("{} is not a folder", there.string()));
    if (access(there.c_str(), W_OK | X_OK) != 0)
        refuse(key, folder, fmt::format("{}: {}", there.string(), std::generic_category().message(errno)));
}

}  // namespace tessera
