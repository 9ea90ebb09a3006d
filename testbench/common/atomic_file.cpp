#include "testbench/common/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

#include "testbench/common/atomic_set.h"
#include "testbench/common/error.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_size = std::size_t{1} << 20;

bool is_shortage(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
        case EIO:
        case ENOMEM:
        case EMFILE:
        case ENFILE:
            return true;
        default:
            return false;
    }
}

/// The process that a name of an unfinished or put aside file holds: .tessera-<process>[-<number>].part, .fst.part or
/// .old; 0 for any other name.
pid_t process_of(const std::string& name) {
    static const std::regex ours("\\.tessera-([0-9]{1,9})(-[0-9]+)?(\\.part|\\.fst\\.part|\\.old)");
    std::smatch parts;
    return std::regex_match(name, parts, ours) ? std::stoi(parts[1]) : 0;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(path) {
    std::error_code problem;
    const fs::file_status status = fs::symlink_status(path, problem);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_symlink(status))
        throw InputError(fmt::format("{}: cannot write: it is a {}, not a file", path.string(),
                                     fs::is_directory(status) ? "folder" : "device"));
    remove_left_overs(path.has_parent_path() ? path.parent_path() : fs::path("."));
    static std::atomic<unsigned> number{0};
    do {
        unfinished_ = path_;
        unfinished_.replace_filename(fmt::format(".tessera-{}-{}.part", ::getpid(), number++));
        looked_after_.emplace(unfinished_);
        file_ = ::open(unfinished_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (file_ < 0 && (errno == EEXIST || errno == EINTR));
    if (file_ < 0) {
        const int error = errno;
        unfinished_.clear();  // not ours to remove
        looked_after_.reset();
        fail("cannot write", error);
    }
    buffer_.reserve(buffer_size);
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::write(std::string_view bytes) {
    buffer_ += bytes;
    if (buffer_.size() >= buffer_size)
        flush();
}

void AtomicFile::flush() {
    std::string_view rest = buffer_;
    while (!rest.empty()) {
        const ssize_t written = ::write(file_, rest.data(), rest.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            fail("writing failed", written < 0 ? errno : EIO);
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
    buffer_.clear();
}

void AtomicFile::commit() {
    flush();
    if (::fsync(file_) != 0)
        fail("writing failed", errno);
    const int file = file_;
    file_ = -1;  // closed even if close complains
    if (::close(file) != 0 && errno != EINTR)
        fail("writing failed", errno);
    AtomicSet* const set = AtomicSet::current();
    std::optional<AtomicSet> alone;
    (set != nullptr ? *set : alone.emplace()).add(unfinished_, path_);
    unfinished_.clear();
    looked_after_.reset();
    if (alone)
        alone->commit();
}

void AtomicFile::fail(const char* what, int error) {
    discard();
    const std::string message =
        fmt::format("{}: {}: {}", path_.string(), what, std::generic_category().message(error));
    if (is_shortage(error))
        throw ResourceError(message);
    throw InputError(message);
}

void AtomicFile::discard() noexcept {
    if (file_ >= 0)
        ::close(file_);
    file_ = -1;
    if (!unfinished_.empty())
        ::unlink(unfinished_.c_str());
    unfinished_.clear();
    looked_after_.reset();
}

void remove_left_overs(const fs::path& folder) {
    std::error_code failed;
    std::vector<fs::path> left;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const pid_t process = process_of(entry.path().filename().string());
        if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH && entry.is_regular_file(failed))
            left.push_back(entry.path());
    }
    for (const fs::path& file : left)
        ::unlink(file.c_str());
}

void write_file(const fs::path& path, std::string_view content) {
    AtomicFile file(path);
    file.write(content);
    file.commit();
}

}  // namespace tessera
