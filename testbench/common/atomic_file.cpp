#include "testbench/common/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <system_error>

#include "testbench/common/error.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_size = std::size_t{1} << 20;

}  // namespace

AtomicFile::AtomicFile(const fs::path& path)
    : path_(path), set_(AtomicSet::current() != nullptr ? *AtomicSet::current() : alone_.emplace(false)) {
    std::error_code absent;
    const fs::file_status status = fs::symlink_status(path, absent);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_symlink(status))
        throw InputError(fmt::format("{}: cannot write: it is a {}, not a file", path.string(),
                                     fs::is_directory(status) ? "folder" : "device"));
    buffer_.reserve(buffer_size);
    file_ = set_.open(path);
}

AtomicFile::~AtomicFile() {
    if (file_ >= 0)
        ::close(file_);
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
            throw_file_error(path_, "writing failed", written < 0 ? errno : EIO);
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
    buffer_.clear();
}

void AtomicFile::commit() {
    flush();
    if (::fsync(file_) != 0)
        throw_file_error(path_, "writing failed", errno);
    const int file = file_;
    file_ = -1;  // closed even if close() fails
    if (::close(file) != 0 && errno != EINTR)
        throw_file_error(path_, "writing failed", errno);
    set_.add(path_);
    if (alone_)
        alone_->commit();
}

void write_file(const fs::path& path, std::string_view content) {
    AtomicFile file(path);
    file.write(content);
    file.commit();
}

}  // namespace tessera
