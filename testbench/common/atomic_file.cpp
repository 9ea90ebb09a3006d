#include "testbench/common/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

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

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(path), target_(path) {
    std::error_code problem;
    const fs::file_status status = fs::status(path, problem);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw InputError(fmt::format("{}: cannot write: it is a {}, not a file", path.string(),
                                     fs::is_directory(status) ? "folder" : "device"));
    if (fs::exists(status) && fs::is_symlink(fs::symlink_status(path, problem))) {
        target_ = fs::canonical(path, problem);
        if (problem)
            fail("cannot write", problem.value());
    }
    static std::atomic<unsigned> number{0};
    do {
        unfinished_ = target_;
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
    (set != nullptr ? *set : alone.emplace()).add(unfinished_, target_);
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

void write_file(const fs::path& path, std::string_view content) {
    AtomicFile file(path);
    file.write(content);
    file.commit();
}

}  // namespace tessera
