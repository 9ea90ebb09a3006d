#include "testbench/common/atomic_set.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <regex>
#include <system_error>

#include "testbench/common/error.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

AtomicSet* living = nullptr;

/// Whether the process that created a staging folder of this name has ended.
bool is_left_over(const std::string& name) {
    static const std::regex ours("\\.tessera-([0-9]{1,9})-[0-9]+\\.part");
    std::smatch parts;
    return std::regex_match(name, parts, ours) && ::kill(std::stoi(parts[1]), 0) != 0 && errno == ESRCH;
}

void remove_left_overs(const fs::path& folder) {
    std::error_code failed;
    std::vector<fs::path> left;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed))
        if (is_left_over(entry.path().filename().string()) && fs::is_directory(entry.symlink_status(failed)))
            left.push_back(entry.path());
    for (const fs::path& staging : left)
        fs::remove_all(staging, failed);
}

/// Makes the names survive a power cut; on file systems that do not support this, the files are written all the same.
void synchronise(const fs::path& folder) {
    const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0)
        return;
    ::fsync(handle);
    ::close(handle);
}

/// Renames that can be undone. Functions return false, with errno, on failure.
class Moves {
  public:
    bool put_aside(const fs::path& file, const fs::path& aside) {
        return !aside.empty() && (move(file, aside, {aside, file}) || errno == ENOENT);  // removed by another run
    }

    /// Keeps an existing `to` as `aside`.
    bool replace(const fs::path& from, const fs::path& to, const fs::path& aside) {
        const bool kept = ::link(to.c_str(), aside.c_str()) == 0;
        // Nothing is at `to`; it was put aside and another run has put a file there; or the file system has no links.
        if (!kept && errno != ENOENT && errno != EEXIST && errno != EPERM && errno != EOPNOTSUPP)
            return false;
        return move(from, to, kept ? Move{aside, to} : Move{to, from});
    }

    bool take_back() {
        bool all = true;
        for (auto move = back_.rbegin(); move != back_.rend(); ++move)
            all = ::rename(move->from.c_str(), move->to.c_str()) == 0 && all;
        return all;
    }

  private:
    struct Move {
        fs::path from, to;
    };
    bool move(const fs::path& from, const fs::path& to, const Move& back) {
        if (::rename(from.c_str(), to.c_str()) != 0)
            return false;
        back_.push_back(back);
        return true;
    }
    std::vector<Move> back_;
};

bool is_job(const fs::path& file) {
    return file.filename() == "job.toml";
}

}  // namespace

void throw_file_error(const fs::path& path, const char* what, int error) {
    const std::string message = fmt::format("{}: {}: {}", path.string(), what, std::generic_category().message(error));
    for (const int shortage : {ENOSPC, EDQUOT, EFBIG, EIO, ENOMEM, EMFILE, ENFILE})
        if (error == shortage)
            throw ResourceError(message);
    throw InputError(message);
}

AtomicSet::AtomicSet(bool is_current) {
    assert(!is_current || living == nullptr);
    if (is_current)
        living = this;
}

AtomicSet::~AtomicSet() {
    if (living == this)
        living = nullptr;
    const Interruption::Delay delay;
    discard();
}

AtomicSet* AtomicSet::current() {
    return living;
}

void AtomicSet::discard() {
    std::error_code ignored;
    for (const auto& each : staging_)
        fs::remove_all(each.second, ignored);
    for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder)
        fs::remove(*folder, ignored);  // fails if it is not empty
    staging_.clear();
    made_.clear();
}

void AtomicSet::make_folder(const fs::path& folder, const std::string& key) {
    const Interruption::Delay delay;
    std::vector<fs::path> missing;
    std::error_code absent;
    for (fs::path path = fs::absolute(folder); !fs::exists(fs::symlink_status(path, absent)); path = path.parent_path())
        missing.push_back(path);
    for (auto path = missing.rbegin(); path != missing.rend(); ++path)
        if (::mkdir(path->c_str(), 0777) == 0)
            made_.push_back(*path);
        else if (errno != EEXIST)
            throw_file_error(folder, (key + " cannot be made").c_str(), errno);
}

/// The path in the staging folder of the new or the old file; creates the folder if necessary. Empty, with errno, on
/// failure.
fs::path AtomicSet::in_staging(const char* what, const fs::path& path) {
    static std::atomic<unsigned> number{0};
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (staging_.count(folder) == 0) {
        remove_left_overs(folder);
        fs::path staging;
        bool made = false;
        do {
            staging = folder / fmt::format(".tessera-{}-{}.part", ::getpid(), number++);
            made = ::mkdir(staging.c_str(), 0777) == 0;
        } while (!made && errno == EEXIST);  // left by an earlier process with this id
        if (!made)
            return {};
        staging_[folder] = staging;
    }
    return staging_[folder] / (what + path.filename().string());
}

fs::path AtomicSet::staged(const fs::path& path) {
    const Interruption::Delay delay;
    return in_staging("new-", path);
}

int AtomicSet::open(const fs::path& path) {
    const Interruption::Delay delay;
    const fs::path staged = in_staging("new-", path);
    const int file = staged.empty() ? -1 : ::open(staged.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0)
        throw_file_error(path, "cannot write", errno);
    return file;
}

void AtomicSet::add(const fs::path& path) {
    files_.push_back(path);
}

void AtomicSet::take_away(const fs::path& file) {
    taken_away_.push_back(file);
}

void AtomicSet::commit() {
    const Interruption::Delay delay;
    Moves moves;
    const auto require = [&](bool moved, const fs::path& file) {
        if (moved)
            return;
        const int error = errno;
        const bool all = moves.take_back();
        if (!all)
            staging_.clear();  // files that could not be restored must not be lost
        throw InputError(
            fmt::format("{}: cannot be replaced: {}; {}: make it and its folder writable, or write to "
                        "another folder",
                        file.string(), std::generic_category().message(error),
                        all ? "all is as it was" : "not all of it could be restored"));
    };
    for (const bool job : {false, true})
        for (const fs::path& file : taken_away_)
            if (is_job(file) == job)
                require(moves.put_aside(file, in_staging("old-", file)), file);
    for (const bool job : {true, false})
        for (const fs::path& file : files_)
            if (is_job(file) == job)
                require(moves.replace(in_staging("new-", file), file, in_staging("old-", file)), file);
    for (const auto& each : staging_)
        synchronise(each.first);
    made_.clear();
    discard();
    Interruption::note("when the results were complete");
}

}  // namespace tessera
