#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "testbench/common/atomic_set.h"

namespace tessera {

/// A file that becomes visible under its name when complete, or not at all: with the current AtomicSet, or without one
/// when commit() has written all bytes to disk. An existing file of the name stays unchanged until then.
///
/// A program that must survive `ulimit -f` has to ignore SIGXFSZ. A link is replaced, not followed; a folder or a
/// device is refused. Errors, with file and the system's reason: as AtomicSet::open().
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);

    /// Call once, after the last write.
    void commit();

  private:
    void flush();

    std::filesystem::path path_;
    std::optional<AtomicSet> alone_;
    AtomicSet& set_;
    int file_ = -1;
    std::string buffer_;
};

/// Writes a whole file.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace tessera
