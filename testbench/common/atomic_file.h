#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "testbench/common/interruption.h"

namespace tessera {

/// A file that appears under its name complete, or not at all: written under another name in the same folder
/// (".tessera-<process>-<number>.part"), and renamed by commit() once every byte is on the disk. An older
/// file of the name stays as it was until then.
///
/// Destroyed without commit(), after an error or an Interruption it leaves nothing. Only a process that is killed can
/// leave the unfinished file: a program that wants to live with `ulimit -f` must ignore SIGXFSZ. While an AtomicSet
/// lives, commit() hands the complete file to it instead of renaming it. A link is replaced, never followed; a
/// folder or a device is refused. What earlier processes that were killed left unfinished in the folder is
/// removed. Errors, with file and the system's reason: ResourceError if disk, quota, file size or memory ran
/// out or the disk failed, else InputError (no such folder, not writable).
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
    [[noreturn]] void fail(const char* what, int error);
    void discard() noexcept;

    std::filesystem::path path_;
    std::filesystem::path unfinished_;
    std::optional<Unfinished> looked_after_;
    int file_ = -1;
    std::string buffer_;
};

/// Removes the unfinished files in a folder whose process no longer runs.
void remove_left_overs(const std::filesystem::path& folder);

/// A whole file at once.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace tessera
