#pragma once
#include <filesystem>
#include <string_view>

namespace tessera::fuzz {

/// A regular file in memory with replaceable content, for readers that take a path. Uses neither the disk nor a name
/// that two processes could share. Linux only.
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

/// The path of this process's file, which holds these bytes until the next call.
const std::filesystem::path& file_of(std::string_view bytes);

}  // namespace tessera::fuzz
