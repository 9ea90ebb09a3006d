#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "testbench/common/atomic_set.h"

namespace tessera {

/// A file that appears under its name complete, or not at all: with the AtomicSet that lives, else when commit() has
/// put every byte on the disk. An older file of the name stays as it was until then.
///
/// A program that wants to live with `ulimit -f` must ignore SIGXFSZ. A link is replaced, never followed; a folder or a
/// device is refused. Errors, with file and the system's reason, as of AtomicSet::open().
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);

    /// To be called once, when all is written.
    void commit();

  private:
    void flush();

    std::filesystem::path path_;
    std::optional<AtomicSet> alone_;
    AtomicSet& set_;
    int file_ = -1;
    std::string buffer_;
};

/// A whole file at once.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace tessera
