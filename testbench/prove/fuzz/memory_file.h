#pragma once
#include <filesystem>
#include <string_view>

namespace tessera::fuzz {

/// A regular file in memory for readers that take a path, its content replaced as often as one likes: no disk, and no
/// name that two processes could share. Linux only.
class MemoryFile {
  public:
    MemoryFile();
    ~MemoryFile();
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    void replace(std::string_view bytes);
    const std::filesystem::path& path() const { return path_; }

  private:
    int descriptor_;
    std::filesystem::path path_;
};

/// This process's own, holding these bytes until it is asked for again.
const std::filesystem::path& file_of(std::string_view bytes);

}  // namespace tessera::fuzz
